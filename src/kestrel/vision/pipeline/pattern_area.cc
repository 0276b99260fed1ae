// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/pattern_area.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kestrel {

cv::Rect PatternArea(const TargetDetection& detection, const TargetShape& shape,
                     const CameraModel& camera) {
  constexpr int kPoints = 24;
  Eigen::Vector2d low(camera.width_px(), camera.height_px());
  Eigen::Vector2d high(-1, -1);
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPoints;
    const Eigen::Vector3d point =
        shape.radius_m() * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
    Eigen::Vector2d pixel;
    const ProjectionStatus status = camera.Project(detection.camera_from_target * point, &pixel);
    if (status == ProjectionStatus::kOutsideModel) continue;
    low = low.cwiseMin(pixel);
    high = high.cwiseMax(pixel);
  }
  low = low.cwiseMax(Eigen::Vector2d(0, 0));
  high = high.cwiseMin(Eigen::Vector2d(camera.width_px() - 1, camera.height_px() - 1));
  if ((low.array() > high.array()).any()) return {};
  return {cv::Point(static_cast<int>(low.x()), static_cast<int>(low.y())),
          cv::Point(static_cast<int>(high.x()) + 1, static_cast<int>(high.y()) + 1)};
}

}  // namespace kestrel
