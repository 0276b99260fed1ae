// SPDX-License-Identifier: BSD-3-Clause
// Draws the landing pattern as seen from 3 m above it, and expects Kestrel to find it there.
#include <cmath>
#include <iostream>
#include <string_view>

#include <opencv2/imgproc.hpp>

#include "kestrel/landing_pipeline.h"
#include "kestrel/version.h"

namespace {

static_assert(std::string_view(kestrel::kVersion) == PACKAGE_VERSION);
static_assert(KESTREL_VERSION_MAJOR + KESTREL_VERSION_MINOR + KESTREL_VERSION_PATCH > 0);

constexpr double kFocal_px = 400;
constexpr double kHeight_m = 3;
const cv::Point kCenter(320, 240);

int Pixels(double length_m) {
  return static_cast<int>(std::lround(length_m * kFocal_px / kHeight_m));
}

cv::Mat DrawPattern(const kestrel::LandingPattern& pattern) {
  cv::Mat image(480, 640, CV_8UC1, cv::Scalar(120));
  const cv::Point corner(Pixels(pattern.board_size_m / 2), Pixels(pattern.board_size_m / 2));
  cv::rectangle(image, kCenter - corner, kCenter + corner, 220, cv::FILLED);
  cv::circle(image, kCenter, Pixels(pattern.outer_radius_m()), 30, cv::FILLED, cv::LINE_AA);
  cv::circle(image, kCenter, Pixels(pattern.inner_radius_m()), 220, cv::FILLED, cv::LINE_AA);
  const int length = Pixels(pattern.arm_half_length_m);
  const int width = Pixels(pattern.arm_width_m / 2);
  for (const cv::Point& half : {cv::Point(length, width), cv::Point(width, length)}) {
    cv::rectangle(image, kCenter - half, kCenter + half, 30, cv::FILLED);
  }
  cv::GaussianBlur(image, image, cv::Size(), 0.6);
  return image;
}

}  // namespace

int main() {
  kestrel::CameraCalibration calibration;
  calibration.intrinsics = {.width_px = 640,
                            .height_px = 480,
                            .fx_px = kFocal_px,
                            .fy_px = kFocal_px,
                            .cx_px = static_cast<double>(kCenter.x),
                            .cy_px = static_cast<double>(kCenter.y)};
  kestrel::LandingPipeline pipeline(calibration, {});
  const cv::Mat image = DrawPattern(pipeline.options().detector.pattern);
  const kestrel::LandingObservation seen = pipeline.Process(image, kestrel::Time{});
  if (!seen.report.detection) {
    std::cout << seen.report.reason << "\n";
    return 1;
  }
  const double distance = seen.report.detection->camera_from_target.translation.norm();
  std::cout << "the pattern is " << distance << " m away\n";
  return std::abs(distance - kHeight_m) < 0.02 * kHeight_m ? 0 : 1;
}
