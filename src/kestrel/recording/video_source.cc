// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/recording/video_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/base/parse_number.h"
#include "kestrel/recording/image_file.h"

namespace kestrel {
namespace {

// Those that decode files; left to itself OpenCV would also look for a camera of this name.
constexpr std::array kFileBackends{cv::CAP_FFMPEG, cv::CAP_GSTREAMER, cv::CAP_OPENCV_MJPEG};

double RateOf(const cv::VideoCapture& capture) {
  const double rate = capture.get(cv::CAP_PROP_FPS);
  return std::isfinite(rate) && rate > 0 && rate < 1e4 ? rate : kNominalRateHz;
}

std::size_t CountOf(const cv::VideoCapture& capture) {
  const double count = capture.get(cv::CAP_PROP_FRAME_COUNT);
  return count > 0 && count < 1e9 ? static_cast<std::size_t>(count) : 0;
}

}  // namespace

VideoSource::VideoSource(const cv::VideoCapture& capture, std::string name, std::size_t frame_count)
    : capture_(capture),
      name_(std::move(name)),
      frame_count_(frame_count),
      rate_hz_(RateOf(capture_)) {}

bool VideoSource::Next(Frame* frame) {
  cv::Mat image;
  if (!capture_.read(image) || image.empty()) {
    CheckEnd();
    return false;
  }
  frame->name = fmt::format("{}/{:06}", name_, next_);
  frame->time = last_time_ = NextTime();
  frame->image = ToFormat(image, format(), frame->name);
  ++next_;
  return true;
}

std::optional<std::size_t> VideoSource::frame_count() const {
  if (frame_count_ == 0) return std::nullopt;
  return frame_count_;
}

Time VideoSource::NextTime() const {
  const double position_ms = capture_.get(cv::CAP_PROP_POS_MSEC);
  const Time time(DurationFromSeconds(std::isfinite(position_ms) ? 1e-3 * position_ms : 0));
  if (next_ == 0) return time;
  return time > last_time_ ? time : last_time_ + DurationFromSeconds(1 / rate_hz_);
}

void VideoSource::CheckEnd() const {
  if (next_ == 0) throw InputError(name_ + ": no frame could be decoded");
  if (next_ + 2 + frame_count_ / 50 < frame_count_) {
    throw InputError(
        fmt::format("{}: the video ends after {} frames, expected {}", name_, next_, frame_count_));
  }
}

VideoSource OpenVideoFile(const std::string& path) {
  cv::VideoCapture capture;
  const auto opens = [&](int backend) { return capture.open(path, backend); };
  if (std::none_of(kFileBackends.begin(), kFileBackends.end(), opens)) {
    throw InputError(path + ": cannot be opened as a video (cut off, or an unknown codec)");
  }
  const std::size_t count = CountOf(capture);
  return VideoSource(capture, path, count);
}

VideoSource OpenCamera(const std::string& camera) {
  if (!camera.starts_with(kVideoDevice)) {
    cv::VideoCapture capture(camera, cv::CAP_GSTREAMER);
    if (!capture.isOpened()) throw InputError(camera + ": this GStreamer pipeline does not start");
    return VideoSource(capture, "gstreamer", 0);
  }
  const auto index = ParseNumber<int>(std::string_view(camera).substr(kVideoDevice.size()));
  cv::VideoCapture capture;
  if (!index || !capture.open(*index)) throw InputError(camera + ": no such camera, or in use");
  return VideoSource(capture, camera, 0);
}

}  // namespace kestrel
