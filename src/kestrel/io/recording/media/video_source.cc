// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/video_source.h"

#include <atomic>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/media/gstreamer.h"
#include "kestrel/io/recording/media/image_file.h"
#include "kestrel/io/recording/media/video_address.h"
#include "kestrel/io/recording/media/video_container.h"
#include "kestrel/io/recording/media/video_decoder.h"
#include "kestrel/io/recording/media/video_device.h"

namespace kestrel {
namespace {

class VideoSource : public FrameSource {
 public:
  VideoSource(std::unique_ptr<VideoDecoder> decoder, std::string name, VideoContainer container)
      : decoder_(std::move(decoder)),
        name_(std::move(name)),
        container_(std::move(container)),
        rate_hz_(RateOf(decoder_->rate_hz())) {}

  std::optional<std::size_t> frame_count() const override {
    const bool is_file = container_.file_bytes > 0;
    if (!is_file || decoder_->frame_count() == 0) return std::nullopt;
    return decoder_->frame_count();
  }
  double rate_hz() const override { return rate_hz_; }

 private:
  bool ReadNext(Frame* frame) override {
    cv::Mat image;
    std::optional<Time> time;
    if (!decoder_->Next(&image, &time)) {
      CheckEnd();
      return false;
    }
    frame->name = fmt::format("{}/{:06}", name_, next_);
    frame->time = last_time_ = NextTime(time);
    frame->image = ToFormat(image, format(), frame->name);
    if (keeps_color()) frame->color = ToFormat(image, PixelFormat::kBgr, frame->name);
    ++next_;
    return true;
  }
  static double RateOf(double rate_hz) {
    return rate_hz > 0 && rate_hz < 1e4 ? rate_hz : kNominalRateHz;
  }
  Time NextTime(const std::optional<Time>& time) const {
    if (next_ == 0) return time.value_or(Time());
    return time && *time > last_time_ ? *time : last_time_ + DurationFromSeconds(1 / rate_hz_);
  }
  void CheckEnd() const {
    if (container_.is_cut_off()) {
      throw InputError(fmt::format("{}: the video is cut off after {} frames: {} of {} bytes",
                                   name_, next_, container_.file_bytes, container_.expected_bytes));
    }
    if (!decoder_->fault().empty()) {
      throw InputError(fmt::format("{}: after {} frames: {}", name_, next_, decoder_->fault()));
    }
  }

  std::unique_ptr<VideoDecoder> decoder_;
  std::string name_;
  VideoContainer container_;
  double rate_hz_;
  std::size_t next_ = 0;
  Time last_time_;
};

// Kinds of the streams in a container. GStreamer's threads set them.
struct StreamKinds {
  std::atomic<bool> has_pictures = false;
  std::atomic<bool> has_sound = false;
};

using SharedKinds = std::shared_ptr<StreamKinds>;

void NoteStream(GstElement* /*demuxer*/, GstPad* pad, gpointer kinds) {
  StreamKinds& noted = **static_cast<SharedKinds*>(kinds);
  const std::string_view name = GST_PAD_NAME(pad);
  if (name.starts_with("video")) noted.has_pictures = true;
  if (name.starts_with("audio")) noted.has_sound = true;
}

void ReleaseKinds(gpointer kinds, GClosure* /*closure*/) {
  delete static_cast<SharedKinds*>(kinds);
}

// decodebin does not listen while it starts a demuxer: it would miss the error that there is
// nothing to decode, and wait. Therefore a known demuxer is put before it.
GstElementPointer FilePipeline(const std::string& path, const std::string& demuxer,
                               const SharedKinds& kinds) {
  const std::string video = demuxer.empty()
                                ? "decodebin caps=video/x-raw expose-all-streams=false"
                                : demuxer + " name=container container.video_0 ! decodebin";
  GstElementPointer pipeline =
      ParsePipeline("filesrc name=file ! " + video + " ! videoconvert ! appsink", path);
  const GstElementPointer file(gst_bin_get_by_name(GST_BIN(pipeline.get()), "file"));
  g_object_set(file.get(), "location", path.c_str(), nullptr);
  if (demuxer.empty()) return pipeline;
  const GstElementPointer container(gst_bin_get_by_name(GST_BIN(pipeline.get()), "container"));
  g_signal_connect_data(container.get(), "pad-added", G_CALLBACK(NoteStream),
                        new SharedKinds(kinds), ReleaseKinds, GConnectFlags());
  return pipeline;
}

// 'fault': text of the error when it does not open.
std::unique_ptr<VideoDecoder> Open(GstElementPointer pipeline, const std::string& fault) {
  try {
    return std::make_unique<VideoDecoder>(std::move(pipeline));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", fault, error.what()));
  }
}

}  // namespace

std::unique_ptr<FrameSource> OpenVideoFile(const std::string& path) {
  VideoContainer container = ReadVideoContainer(path);
  const auto kinds = std::make_shared<StreamKinds>();
  GstElementPointer pipeline = FilePipeline(path, container.demuxer, kinds);
  try {
    auto decoder = Open(std::move(pipeline), path + ": cannot be opened as a video");
    return std::make_unique<VideoSource>(std::move(decoder), path, std::move(container));
  } catch (const InputError&) {
    if (!kinds->has_sound || kinds->has_pictures) throw;
    throw InputError(path + ": has no pictures, only sound");
  }
}

std::unique_ptr<FrameSource> OpenCamera(const std::string& camera) {
  const bool is_pipeline = camera.find('!') != std::string::npos;
  const std::string name = WithoutPassword(camera);
  GstElementPointer pipeline = ParsePipeline(CameraPipelineText(camera, ""), camera);
  try {
    auto decoder = std::make_unique<VideoDecoder>(std::move(pipeline));
    return std::make_unique<VideoSource>(std::move(decoder), is_pipeline ? "gstreamer" : name,
                                         VideoContainer());
  } catch (const InputError& error) {
    const std::string fault = CameraFault(camera);
    if (!fault.empty()) throw InputError(fault);
    throw InputError(fmt::format(
        "{}: {}: {}", name,
        is_pipeline ? "this GStreamer pipeline does not start" : "the camera does not start",
        error.what()));
  }
}

}  // namespace kestrel
