// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/object_view.h"

#include <cmath>
#include <numbers>

namespace kestrel {

bool ObjectView::Shows(const MappedObject& object) const {
  constexpr double kMaxSigma_m = 0.5;
  constexpr double kMarginPx = 10;
  constexpr double kAreaFactor = 3;  // well above the smallest size that is found
  if (!saw_all_ || object.sigma_m() > kMaxSigma_m) return false;
  const auto class_index = ClassOf(object, detector_.model());
  if (!class_index) return false;
  const Eigen::Vector3d in_camera = camera_from_world_ * object.position();
  const CameraModel& camera = detector_.camera();
  Eigen::Vector2d pixel;
  if (!(in_camera.z() > 0) || camera.Project(in_camera, &pixel) != ProjectionStatus::kOk) {
    return false;
  }
  const double size_m = detector_.model().classes[*class_index].size_m;
  const double radius_px = 0.5 * size_m * camera.intrinsics().fx_px / in_camera.norm();
  // Foreshortening reduces its area.
  const Eigen::Vector3d up = camera_from_world_.rotation * Eigen::Vector3d::UnitZ();
  const double foreshortening = -up.dot(in_camera.normalized());
  const double area_px = std::numbers::pi * radius_px * radius_px * foreshortening;
  if (area_px < kAreaFactor * detector_.options().min_pixels) return false;
  const double reach_px =
      radius_px + kMarginPx + 2 * object.sigma_m() * camera.intrinsics().fx_px / in_camera.norm();
  if (pixel.x() < reach_px || pixel.y() < reach_px || pixel.x() > camera.width_px() - reach_px ||
      pixel.y() > camera.height_px() - reach_px) {
    return false;
  }
  for (const ObjectDetection& detection : report_.detections) {
    if ((detection.center_px - pixel).norm() < reach_px + detection.ellipse.semi_major) {
      return false;
    }
  }
  return true;
}

}  // namespace kestrel
