// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/video_decoder.h"

#include <cmath>
#include <gst/app/gstappsink.h>
#include <utility>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

std::optional<GstVideoInfo> InfoOf(GstSample* sample) {
  GstVideoInfo info;
  if (gst_video_info_from_caps(&info, gst_sample_get_caps(sample)) == FALSE) return std::nullopt;
  return info;
}

std::optional<Time> TimeOf(GstSample* sample) {
  const GstClockTime pts = GST_BUFFER_PTS(gst_sample_get_buffer(sample));
  if (!GST_CLOCK_TIME_IS_VALID(pts)) return std::nullopt;
  const GstClockTime time =
      gst_segment_to_stream_time(gst_sample_get_segment(sample), GST_FORMAT_TIME, pts);
  if (!GST_CLOCK_TIME_IS_VALID(time)) return std::nullopt;
  return TimeFromNanoseconds(static_cast<std::int64_t>(time));
}

}  // namespace

VideoDecoder::VideoDecoder(GstElementPointer pipeline)
    : pipeline_(std::move(pipeline)),
      sink_(FindAppSink(pipeline_.get(), "GStreamer")),
      watch_(pipeline_.get()) {
  constexpr guint kAhead = 4;
  SetPixelFormat(sink_.get(), PixelFormat::kBgr);
  gst_app_sink_set_max_buffers(GST_APP_SINK(sink_.get()), kAhead);
  gst_base_sink_set_sync(GST_BASE_SINK(sink_.get()), FALSE);
  gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
  first_ = Pull();
  const auto info = first_ ? InfoOf(first_.get()) : std::nullopt;
  if (!info) {
    gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
    throw InputError(fault_.empty() ? "there is no image" : fault_);
  }
  if (info->fps_d > 0) rate_hz_ = static_cast<double>(info->fps_n) / info->fps_d;
  frame_count_ = RequestCount();
}

VideoDecoder::~VideoDecoder() { gst_element_set_state(pipeline_.get(), GST_STATE_NULL); }

bool VideoDecoder::Next(cv::Mat* image, std::optional<Time>* time) {
  const GstSamplePointer sample = first_ ? std::move(first_) : Pull();
  if (!sample) return false;
  const auto info = InfoOf(sample.get());
  if (info) *image = cv::Mat(info->height, info->width, CV_8UC3);
  if (!info || !CopyPixels(sample.get(), *info, image)) {
    fault_ = "an image cannot be read";
    return false;
  }
  *time = TimeOf(sample.get());
  return true;
}

// The sink does not see an error of the pipeline as the end of the stream: both must be checked.
GstSamplePointer VideoDecoder::Pull() {
  constexpr Duration kLook = std::chrono::milliseconds(100);
  constexpr Duration kStall = std::chrono::seconds(30);
  for (Duration waited{}; waited < kStall; waited += kLook) {
    if (GstSamplePointer sample = PullSample(sink_.get(), kLook)) return sample;
    watch_.Poll();
    fault_ = watch_.fault();
    if (!fault_.empty() || gst_app_sink_is_eos(GST_APP_SINK(sink_.get())) != FALSE) return nullptr;
  }
  fault_ = "no image came for 30 s";
  return nullptr;
}

std::size_t VideoDecoder::RequestCount() const {
  gint64 frames = 0;
  if (gst_element_query_duration(pipeline_.get(), GST_FORMAT_DEFAULT, &frames) != FALSE &&
      frames > 0) {
    return static_cast<std::size_t>(frames);
  }
  gint64 ns = 0;
  if (gst_element_query_duration(pipeline_.get(), GST_FORMAT_TIME, &ns) == FALSE || ns <= 0) {
    return 0;
  }
  return static_cast<std::size_t>(std::round(1e-9 * static_cast<double>(ns) * rate_hz_));
}

}  // namespace kestrel
