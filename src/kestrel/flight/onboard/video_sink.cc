// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/video_sink.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/flight/session/asynchronous_sink.h"

namespace kestrel {
namespace {

// Writes the age into the lower right corner.
void DrawAge(Duration age, cv::Mat* image) {
  constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
  const double scale = std::clamp(image->cols / 1500.0, 0.3, 2.5);
  const int thin = std::max(1, static_cast<int>(scale));
  const std::string text = fmt::format("{:.0f} ms", 1e3 * ToSeconds(age));
  const cv::Size size = cv::getTextSize(text, kFont, scale, 3 * thin, nullptr);
  const cv::Point place(image->cols - size.width - 4, image->rows - size.height / 2);
  for (const auto& [thickness, ink] :
       {std::pair(3, cv::Scalar::all(0)), std::pair(1, cv::Scalar::all(255))}) {
    cv::putText(*image, text, place, kFont, scale, ink, thickness * thin, cv::LINE_AA);
  }
}

class VideoWriter : public SinkWriter {
 public:
  VideoWriter(VideoServer* server, ObservationPainter painter)
      : server_(*server), painter_(std::move(painter)) {}

  bool IsWanted() const override { return server_.IsWatched(); }

  void Write(const Observation& observation, std::size_t /*waiting*/) override {
    const Duration period = DurationFromSeconds(1 / kVideoRate_hz);
    const Time now = Now();
    if (observation.frame.camera != 0 || now < due_) return;
    due_ = std::max(due_ + period, now);
    cv::Mat picture = painter_(observation);
    if (picture.channels() == 1) cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
    DrawAge(now - observation.frame.time, &picture);
    server_.Show(picture, observation.frame.time);
  }

 private:
  VideoServer& server_;
  ObservationPainter painter_;
  Time due_{};
};

}  // namespace

std::unique_ptr<ObservationSink> MakeVideoSink(VideoServer* server, ObservationPainter painter,
                                               std::function<void(const std::string&)> notify) {
  constexpr int kNiceness = 10;
  return std::make_unique<AsynchronousSink>(
      AsynchronousSinkOptions{
          .thread_name = "video", .frames = 1, .niceness = kNiceness, .notify = std::move(notify)},
      std::make_unique<VideoWriter>(server, std::move(painter)));
}

}  // namespace kestrel
