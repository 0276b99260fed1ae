// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/pattern_view.h"

namespace kestrel {

PatternView::PatternView(const CameraModel& camera, const RigidTransform& camera_from_pattern,
                         double extent_m, const ImageRegion& region)
    : extent_m_(static_cast<float>(extent_m)),
      nodes_per_m_(static_cast<float>((kNodes - 1) / (2 * extent_m))) {
  const Eigen::Matrix3d rotation = camera_from_pattern.rotation.toRotationMatrix();
  for (int iy = 0; iy < kNodes; ++iy) {
    for (int ix = 0; ix < kNodes; ++ix) {
      const double x = extent_m * (2.0 * ix / (kNodes - 1) - 1);
      const double y = extent_m * (2.0 * iy / (kNodes - 1) - 1);
      const Eigen::Vector3d point =
          rotation.col(0) * x + rotation.col(1) * y + camera_from_pattern.translation;
      Eigen::Vector2d pixel;
      if (camera.Project(point, &pixel) == ProjectionStatus::kOutsideModel) {
        valid_ = false;
        return;
      }
      nodes_[iy * kNodes + ix] = region.FromFull(pixel).cast<float>();
    }
  }
}

}  // namespace kestrel
