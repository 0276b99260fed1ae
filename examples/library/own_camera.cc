// SPDX-License-Identifier: BSD-3-Clause
// A camera of one's own in a session: finds the landing pattern in its images and writes what
// was found as JSON lines. With an argument, as "serial:///dev/ttyAMA0:921600", it tells an
// autopilot where the pattern is.
#include <chrono>
#include <iostream>
#include <memory>
#include <string>
#include <thread>

#include <opencv2/imgproc.hpp>

#include "json_lines_sink.h"
#include "kestrel/session.h"

namespace {

using namespace std::chrono_literals;

// Draws the pattern as it drives by 3 m below, 20 times a second for 2 s. Yours gets images here.
class DrawnCamera : public kestrel::LiveSource {
 public:
  std::optional<kestrel::Event> Next(kestrel::Duration /*timeout*/) override {
    if (captured_ == 40) return kestrel::EndOfStream();
    std::this_thread::sleep_for(50ms);
    cv::Mat image(480, 640, CV_8UC1, cv::Scalar(120));
    const cv::Point center(300 + static_cast<int>(captured_), 240);
    cv::rectangle(image, center - cv::Point(100, 100), center + cv::Point(100, 100), 220,
                  cv::FILLED);
    cv::circle(image, center, 67, 30, cv::FILLED, cv::LINE_AA);
    cv::circle(image, center, 53, 220, cv::FILLED, cv::LINE_AA);
    cv::rectangle(image, center - cv::Point(51, 7), center + cv::Point(51, 7), 30, cv::FILLED);
    cv::rectangle(image, center - cv::Point(7, 51), center + cv::Point(7, 51), 30, cv::FILLED);
    cv::GaussianBlur(image, image, cv::Size(), 0.6);
    return kestrel::Frame{std::to_string(captured_++), kestrel::Now(), image};
  }

  kestrel::CaptureCounters counters() const override { return {.captured = captured_}; }

 private:
  std::uint64_t captured_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  kestrel::OpenedLiveSource camera{.source = std::make_unique<DrawnCamera>()};
  camera.calibration.intrinsics = {
      .width_px = 640, .height_px = 480, .fx_px = 400, .fy_px = 400, .cx_px = 320, .cy_px = 240};
  kestrel::SessionOptions options;
  if (argc > 1) options.autopilot = argv[1];
  const auto session = kestrel::MakeSession(camera, kestrel::LandTask({}), options);
  const auto* const sink = session->sinks().Add(std::make_unique<JsonLinesSink>(&std::cout));
  session->Run();
  std::cerr << session->Summary();
  return sink->lines() > 30 ? 0 : 1;
}
