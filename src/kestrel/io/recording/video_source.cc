// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/video_source.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/gstreamer.h"
#include "kestrel/io/recording/image_file.h"
#include "kestrel/io/recording/video_decoder.h"

namespace kestrel {
namespace {

class VideoSource : public FrameSource {
 public:
  // 'frame_count': 0 when it is unknown or there is no end.
  VideoSource(std::unique_ptr<VideoDecoder> decoder, std::string name, std::size_t frame_count)
      : decoder_(std::move(decoder)),
        name_(std::move(name)),
        frame_count_(frame_count),
        rate_hz_(RateOf(decoder_->rate_hz())) {}

  bool Next(Frame* frame) override {
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
  std::optional<std::size_t> frame_count() const override {
    if (frame_count_ == 0) return std::nullopt;
    return frame_count_;
  }
  double rate_hz() const override { return rate_hz_; }

 private:
  static double RateOf(double rate_hz) {
    return rate_hz > 0 && rate_hz < 1e4 ? rate_hz : kNominalRateHz;
  }
  Time NextTime(const std::optional<Time>& time) const {
    if (next_ == 0) return time.value_or(Time());
    return time && *time > last_time_ ? *time : last_time_ + DurationFromSeconds(1 / rate_hz_);
  }
  void CheckEnd() const {
    if (next_ + 2 + frame_count_ / 50 < frame_count_) {
      throw InputError(fmt::format("{}: the video ends after {} frames, expected {}", name_, next_,
                                   frame_count_));
    }
    if (!decoder_->fault().empty()) {
      throw InputError(fmt::format("{}: after {} frames: {}", name_, next_, decoder_->fault()));
    }
  }

  std::unique_ptr<VideoDecoder> decoder_;
  std::string name_;
  std::size_t frame_count_;
  double rate_hz_;
  std::size_t next_ = 0;
  Time last_time_;
};

// The first bytes of a video file.
class FileHead {
 public:
  explicit FileHead(const std::string& path) {
    std::ifstream(path, std::ios::binary).read(bytes_.data(), bytes_.size());
  }

  // Returns GStreamer's element for the container; empty when another element may be needed.
  const char* Demuxer() const {
    if (IsAvi()) return "avidemux";
    if (HasAt(4, "ftyp")) return "qtdemux";
    return HasAt(0, "\x1a\x45\xdf\xa3") ? "matroskademux" : "";
  }
  // Returns the number of frames in the header of an AVI, else 0. GStreamer counts the frames that
  // exist, and would not notice that a file is cut off.
  std::size_t FrameCount() const {
    if (!IsAvi() || !HasAt(24, "avih")) return 0;
    std::size_t count = 0;
    for (std::size_t i = 4; i-- > 0;) {
      count = count << 8 | static_cast<unsigned char>(bytes_[kAviCount + i]);
    }
    constexpr std::size_t kMost = 1'000'000'000;
    return count < kMost ? count : 0;
  }

 private:
  static constexpr std::size_t kAviCount = 48;  // position of dwTotalFrames

  bool HasAt(std::size_t place, std::string_view text) const {
    return std::string_view(bytes_.data(), bytes_.size()).substr(place).starts_with(text);
  }
  bool IsAvi() const { return HasAt(0, "RIFF") && HasAt(8, "AVI "); }

  std::array<char, kAviCount + 4> bytes_{};
};

// decodebin does not listen while it starts a demuxer: it would miss the error that there is
// nothing to decode, and wait. Therefore a known demuxer is put before it.
GstElementPointer FilePipeline(const std::string& path, const FileHead& head) {
  const std::string demuxer = head.Demuxer();
  const std::string video = demuxer.empty()
                                ? "decodebin caps=video/x-raw expose-all-streams=false"
                                : demuxer + " name=container container.video_0 ! decodebin";
  GstElementPointer pipeline =
      ParsePipeline("filesrc name=file ! " + video + " ! videoconvert ! appsink", path);
  const GstElementPointer file(gst_bin_get_by_name(GST_BIN(pipeline.get()), "file"));
  g_object_set(file.get(), "location", path.c_str(), nullptr);
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
  const FileHead head(path);
  auto decoder = Open(FilePipeline(path, head), path + ": cannot be opened as a video");
  const std::size_t count = std::max(decoder->frame_count(), head.FrameCount());
  return std::make_unique<VideoSource>(std::move(decoder), path, count);
}

std::unique_ptr<FrameSource> OpenCamera(const std::string& camera) {
  const bool is_pipeline = camera.find('!') != std::string::npos;
  GstElementPointer pipeline = ParsePipeline(CameraPipelineText(camera, ""), camera);
  const char* fault =
      is_pipeline ? "this GStreamer pipeline does not start" : "no such camera, or in use";
  auto decoder = Open(std::move(pipeline), fmt::format("{}: {}", camera, fault));
  return std::make_unique<VideoSource>(std::move(decoder), is_pipeline ? "gstreamer" : camera, 0);
}

}  // namespace kestrel
