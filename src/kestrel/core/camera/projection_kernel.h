// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

namespace kestrel {

// A lens in single precision, for CameraModel::ProjectMany.
struct ProjectionKernel {
  bool is_equidistant;
  std::array<float, 8> k;  // coefficients of the distortion, padded with zeros
  float limit;             // largest angle to the axis (rad) when equidistant, else its tangent
  float fx_px, fy_px;
  float cx_px, cy_px;
};

// CameraModel::Project for 'count' points, with the best vector instructions of the machine, chosen
// at run time. 'd_pixel_d_point': six columns, row by row, or nullptr.
void ProjectPoints(const ProjectionKernel& kernel, const std::array<const float*, 3>& points,
                   std::size_t count, float* x_px, float* y_px,
                   const std::array<float*, 6>* d_pixel_d_point);

}  // namespace kestrel
