// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/camera/ray_kernel.h"

namespace kestrel {

// Converts pixels to unit rays by a precomputed table. It replaces the undistorted pixels of the
// paper's Algorithm 2, because rays exist past 90 degrees and undistorted pixels do not. Immutable,
// thread-safe, copyable. Ray and Rays neither allocate nor throw.
//
// The table reaches to 1.5 times the distance of the image's farthest corner from the principal
// point, and to 170 degrees from the axis. Inside of the image it is within 0.01 px of
// CameraModel::Unproject, except in the last tenth of a pixel before the radius at which a lens
// model folds back: 0.02 px (docs/camera.md).
class RayTable {
 public:
  explicit RayTable(const CameraModel& camera);

  // Returns the unit ray through a pixel; the zero vector outside of the lens model, outside of the
  // table, and for NaN.
  Eigen::Vector3f Ray(float u_px, float v_px) const {
    Eigen::Vector3f ray;
    ComputeRay(Kernel(), u_px, v_px, ray.data());
    return ray;
  }

  // The same for 'count' pixels, vectorized. The arrays must not overlap.
  void Rays(const float* u_px, const float* v_px, std::size_t count, float* x, float* y,
            float* z) const {
    ComputeRays(Kernel(), u_px, v_px, count, x, y, z);
  }

 private:
  // Returns the kernel with a pointer to this object's table, because a copy has its own table.
  RayKernel Kernel() const {
    RayKernel kernel = kernel_;
    kernel.table = table_.data();
    return kernel;
  }
  double MaxErrorPx(const CameraModel& camera) const;

  std::vector<float> table_;
  RayKernel kernel_{};  // 'table' is not set
};

}  // namespace kestrel
