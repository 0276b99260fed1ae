// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/landing/image_region.h"
#include "kestrel/vision/target/plane_warp.h"

namespace kestrel {

// Maps the plane of the pattern to the pixels of an image under an assumed pose.
class PatternView {
 public:
  // Covers |x|, |y| <= 'extent_m' (m) of the plane. Pixels are those of 'region'.
  PatternView(const CameraModel& camera, const RigidTransform& camera_from_target, double extent_m,
              const ImageRegion& region);
  PatternView(const PlaneWarp& warp, double extent_m, const ImageRegion& region);

  // False when the lens model does not cover the whole extent.
  bool valid() const { return valid_; }

  // Writes the gray values at 'count' points of the plane (m), which must lie within the extent;
  // negative where a point is outside of 'image', which shows the region. The arrays must not
  // overlap.
  void Sample(const cv::Mat& image, const float* x_m, const float* y_m, std::size_t count,
              float* gray) const;

  // Writes the pixels of such points.
  void Project(const float* x_m, const float* y_m, std::size_t count, float* x_px,
               float* y_px) const;

 private:
  PlaneWarp warp_;
  ImageRegion region_;
  bool valid_;
};

}  // namespace kestrel
