// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/gstreamer.h"

#include <algorithm>
#include <gst/app/gstappsink.h>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/media/video_address.h"
#include "kestrel/io/recording/media/whole_pictures.h"

namespace kestrel {
namespace {

using GstErrorPointer = std::unique_ptr<GError, GstReleaser>;

void InitialiseGstreamer() {
  GError* error = nullptr;
  if (gst_init_check(nullptr, nullptr, &error) != FALSE) return;
  const GstErrorPointer owner(error);
  throw InputError(fmt::format("GStreamer does not start: {}", error ? error->message : "unknown"));
}

std::string FirstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

GstClockTime Nanoseconds(Duration timeout) {
  return static_cast<GstClockTime>(std::max<std::int64_t>(timeout.count(), 0));
}

void SetIfThere(GstElement* element, const char* property) {
  if (g_object_class_find_property(G_OBJECT_GET_CLASS(element), property) == nullptr) return;
  g_object_set(element, property, TRUE, nullptr);
}

void SetUpElement(GstBin* /*pipeline*/, GstBin* /*parent*/, GstElement* element, gpointer) {
  SetIfThere(element, "request-keyframe");
  PassWholePicturesOnly(element);
}

// GStreamer has these properties only from 1.20 or 1.22 on.
void SetUpNetworkVideo(GstElement* pipeline) {
  const GstElementPointer network(gst_bin_get_by_name(GST_BIN(pipeline), "network"));
  if (network) SetIfThere(network.get(), "add-reference-timestamp-meta");
  g_signal_connect(pipeline, "deep-element-added", G_CALLBACK(SetUpElement), nullptr);
}

// What an RTSP server or the way to it says, in words for the user; empty for other errors.
std::string WordsOfNetworkError(GstMessage* message, const GError& error) {
  const std::string_view element = G_OBJECT_TYPE_NAME(GST_MESSAGE_SRC(message));
  if (element != "GstRTSPSrc" || error.domain != GST_RESOURCE_ERROR) return "";
  switch (error.code) {
    case GST_RESOURCE_ERROR_OPEN_READ_WRITE:
      return "no connection: is the camera on, the address right?";
    case GST_RESOURCE_ERROR_NOT_AUTHORIZED:
      return "the camera refuses user and password (rtsp://USER:PASSWORD@HOST/...)";
    case GST_RESOURCE_ERROR_NOT_FOUND:
      return "the camera has no such stream: is the path of the address right?";
    default:
      return "";
  }
}

}  // namespace

std::string CameraPipelineText(const std::string& camera, const std::string& device_caps) {
  constexpr const char* kEnd = " ! videoconvert ! appsink";
  if (IsVideoAddress(camera)) {
    return fmt::format("{} ! decodebin{}", NetworkVideoText(camera), kEnd);
  }
  if (!camera.starts_with("/dev/video")) {
    return camera.find("appsink") == std::string::npos ? camera + kEnd : camera;
  }
  if (device_caps.empty()) return fmt::format("v4l2src device={} ! decodebin{}", camera, kEnd);
  const char* decoder = device_caps.starts_with("image/jpeg") ? " ! jpegdec" : "";
  return fmt::format("v4l2src device={} ! {}{}{}", camera, device_caps, decoder, kEnd);
}

GstElementPointer ParsePipeline(const std::string& text, const std::string& name) {
  InitialiseGstreamer();
  GError* error = nullptr;
  GstElementPointer pipeline(
      gst_parse_launch_full(text.c_str(), nullptr, GST_PARSE_FLAG_FATAL_ERRORS, &error));
  const GstErrorPointer owner(error);
  if (error != nullptr)
    throw InputError(
        WithoutPassword(fmt::format("{}: GStreamer: {}", name, FirstLine(error->message))));
  if (!GST_IS_PIPELINE(pipeline.get())) {
    throw InputError(name + ": is no GStreamer pipeline, expected elements joined by '!'");
  }
  SetUpNetworkVideo(pipeline.get());
  return pipeline;
}

GstElementPointer FindAppSink(GstElement* pipeline, const std::string& name) {
  GstIterator* sinks = gst_bin_iterate_sinks(GST_BIN(pipeline));
  const auto is_other = [](gconstpointer item, gconstpointer) {
    return GST_IS_APP_SINK(g_value_get_object(static_cast<const GValue*>(item))) ? 0 : 1;
  };
  GValue found = G_VALUE_INIT;
  const bool is_found = gst_iterator_find_custom(sinks, is_other, &found, nullptr) != FALSE;
  gst_iterator_free(sinks);
  if (!is_found) throw InputError(name + ": the pipeline has no appsink at its end");
  GstElementPointer sink(GST_ELEMENT(g_value_dup_object(&found)));
  g_value_unset(&found);
  return sink;
}

void SetPixelFormat(GstElement* sink, PixelFormat format) {
  const GstCapsPointer caps(gst_caps_new_simple("video/x-raw", "format", G_TYPE_STRING,
                                                format == PixelFormat::kGray ? "GRAY8" : "BGR",
                                                nullptr));
  gst_app_sink_set_caps(GST_APP_SINK(sink), caps.get());
}

GstSamplePointer PullSample(GstElement* sink, Duration timeout) {
  return GstSamplePointer(gst_app_sink_try_pull_sample(GST_APP_SINK(sink), Nanoseconds(timeout)));
}

bool CopyPixels(GstSample* sample, const GstVideoInfo& info, cv::Mat* image) {
  GstVideoFrame frame;
  if (gst_video_frame_map(&frame, &info, gst_sample_get_buffer(sample), GST_MAP_READ) == FALSE) {
    return false;
  }
  const cv::Mat pixels(image->size(), image->type(), GST_VIDEO_FRAME_PLANE_DATA(&frame, 0),
                       static_cast<std::size_t>(GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0)));
  pixels.copyTo(*image);
  gst_video_frame_unmap(&frame);
  return true;
}

GstBufferPointer BufferOf(const cv::Mat& image, const GstVideoInfo& info) {
  GstBufferPointer buffer(gst_buffer_new_allocate(nullptr, info.size, nullptr));
  GstVideoFrame frame;
  if (gst_video_frame_map(&frame, &info, buffer.get(), GST_MAP_WRITE) == FALSE) return nullptr;
  cv::Mat pixels(image.size(), CV_8UC3, GST_VIDEO_FRAME_PLANE_DATA(&frame, 0),
                 static_cast<std::size_t>(GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0)));
  image.copyTo(pixels);
  gst_video_frame_unmap(&frame);
  return buffer;
}

void GstWatch::Poll(Duration timeout) {
  constexpr auto kKinds =
      static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS | GST_MESSAGE_ELEMENT);
  GstClockTime wait = Nanoseconds(timeout);
  while (const GstMessagePointer message{gst_bus_timed_pop_filtered(bus_.get(), wait, kKinds)}) {
    Take(message.get());
    wait = 0;
  }
}

void GstWatch::Take(GstMessage* message) {
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS) has_ended_ = true;
  const GstStructure* structure = gst_message_get_structure(message);
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ELEMENT &&
      gst_structure_has_name(structure, "missing-plugin")) {
    const char* missing = gst_structure_get_string(structure, "name");
    if (missing != nullptr) missing_ = missing;
  }
  if (GST_MESSAGE_TYPE(message) != GST_MESSAGE_ERROR || !fault_.empty()) return;
  GError* error = nullptr;
  gst_message_parse_error(message, &error, nullptr);
  const GstErrorPointer owner(error);
  fault_ = WordsOfNetworkError(message, *error);
  if (!fault_.empty()) return;
  fault_ = missing_.empty() ? FirstLine(error->message)
                            : fmt::format(
                                  "GStreamer has no {}: install the plugins that have it "
                                  "(gstreamer1.0-libav, -plugins-bad or -plugins-ugly)",
                                  missing_);
}

}  // namespace kestrel
