// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "kestrel/core/camera/camera_model.h"

namespace kestrel {

// The two methods of the paper (section 2.2), to compare with: RayTable is what the detectors use.
// Both give a point of the undistorted plane z = 1, so both end before 90 degrees from the axis.

// Algorithm 1: the angle by ten fixed-point steps from the distorted radius. 'camera' must be
// equidistant. Past 90 degrees the point is on the wrong side of the centre, and where the
// iteration does not converge it is wherever the tenth step left it.
Eigen::Vector2d UndistortIterative(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel);

// Algorithm 2: the scale tan(theta) / radius of Algorithm 1, tabulated over the squared distorted
// radius from 0 to that of the image's farthest corner. The paper does not say how its table is
// read between two entries; here the nearest one is taken. Immutable, thread-safe.
class FisheyeUndistortionTable {
 public:
  static constexpr int kEntries = 2000;

  // Throws InputError when 'camera' is not a valid equidistant camera.
  explicit FisheyeUndistortionTable(const CameraIntrinsics& camera);

  // Beyond the farthest corner the last entry's scale is used. 'pixel' must be finite.
  Eigen::Vector2f Undistort(const Eigen::Vector2f& pixel) const;

 private:
  std::vector<float> scale_;
  Eigen::Array2f center_px_;
  Eigen::Array2f inverse_focal_;
  float entries_per_squared_radius_;
};

}  // namespace kestrel
