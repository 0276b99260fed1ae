// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/camera_lens.h"

#include <cmath>

namespace kestrel {

CameraLens::CameraLens(const CameraCalibration& calibration, std::size_t capacity)
    : zoom_(*calibration.zoom),
      image_to_zoom_(calibration.clock_offset.value_or(Duration::zero()) - zoom_.clock_offset),
      history_(capacity),
      turn_(calibration.intrinsics, /*may_zoom=*/true) {}

std::optional<double> CameraLens::ViewAt(const cv::Mat& image, Time image_time) {
  // A UAV that sinks at 2 m/s to 2 m changes the scale by a seventh at ten images a second.
  constexpr double kSwitch = 1.2;
  const Time time = image_time + image_to_zoom_;
  if (turn_.Add(image) && std::abs(std::log(turn_.scale())) > std::log(kSwitch)) {
    history_.Break(time);
  }
  return history_.At(time);
}

}  // namespace kestrel
