// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "kestrel/core/camera/camera_model.h"

namespace kestrel {

// The paper's two methods (section 2.2), for comparison; the detectors use RayTable. Both return a
// point of the undistorted plane z = 1, so both end before 90 degrees from the axis.

// Algorithm 1: computes the angle from the distorted radius by ten fixed-point steps. 'camera' must
// be equidistant. Past 90 degrees the point is on the wrong side of the centre. Where the iteration
// does not converge, the result is that of the tenth step.
Eigen::Vector2d UndistortIterative(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel);

// Algorithm 2: the scale tan(theta) / radius of Algorithm 1, tabulated over the squared distorted
// radius up to that of the image's farthest corner. The paper does not specify interpolation
// between entries; this uses the nearest entry. Immutable, thread-safe.
class FisheyeUndistortionTable {
 public:
  static constexpr int kEntries = 2000;

  // Throws InputError when 'camera' is not a valid equidistant camera.
  explicit FisheyeUndistortionTable(const CameraIntrinsics& camera);

  // 'pixel' must be finite. Beyond the farthest corner it uses the scale of the last entry.
  Eigen::Vector2f Undistort(const Eigen::Vector2f& pixel) const;

 private:
  std::vector<float> scale_;
  Eigen::Array2f center_px_;
  Eigen::Array2f inverse_focal_;
  float entries_per_squared_radius_;
};

}  // namespace kestrel
