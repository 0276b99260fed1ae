// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace kestrel {

// The arithmetic of RayTable, for one point and for many. With w the pixel in units of the focal
// length from the principal point and q = |w|^2, the table holds T(q) = tan(theta / 2) / |w|, theta
// the angle of the ray to the axis: the ray is the inverse stereographic projection of T w,
//   x = 2 T w_x / (1 + T^2 q),  y = 2 T w_y / (1 + T^2 q),  z = (1 - T^2 q) / (1 + T^2 q),
// of unit length by construction, and T is smooth and finite past 90 degrees.
struct RayKernel {
  const float* table;  // T at q = i / cells_per_q, i = 0 ... cells + 1
  float cells_per_q;
  float end_q;  // q beyond it is outside of the table
  float min_z;  // a ray with a smaller z is outside of the model
  float cx_px, cy_px;
  float inverse_fx, inverse_fy;
  float p1, p2;     // tangential part
  int corrections;  // number of iterations that remove the tangential part
};

// Scalar twin of ComputeRays. Writes zeros for a pixel that is NaN or outside of the model.
inline void ComputeRay(const RayKernel& kernel, float u_px, float v_px, float* ray) {
  const float distorted_x = (u_px - kernel.cx_px) * kernel.inverse_fx;
  const float distorted_y = (v_px - kernel.cy_px) * kernel.inverse_fy;
  float x = distorted_x;
  float y = distorted_y;
  for (int i = 0;; ++i) {
    const float q = x * x + y * y;
    const bool in_table = q < kernel.end_q;
    const float position = in_table ? q * kernel.cells_per_q : 0.0f;
    const int cell = static_cast<int>(position);
    const float* knot = kernel.table + cell;
    const float t = knot[0] + (position - static_cast<float>(cell)) * (knot[1] - knot[0]);
    const float tangent2 = t * t * q;  // squared tangent of half the angle
    if (i == kernel.corrections) {
      const float scale = 1 / (1 + tangent2);
      ray[2] = (1 - tangent2) * scale;
      const bool valid = in_table && ray[2] >= kernel.min_z;
      ray[0] = valid ? 2 * t * x * scale : 0.0f;
      ray[1] = valid ? 2 * t * y * scale : 0.0f;
      ray[2] = valid ? ray[2] : 0.0f;
      return;
    }
    const float to_plane = 2 * t / (1 - tangent2);
    const float plane_x = to_plane * x;
    const float plane_y = to_plane * y;
    const float s = plane_x * plane_x + plane_y * plane_y;
    const float both = 2 * plane_x * plane_y;
    x = distorted_x - (kernel.p1 * both + kernel.p2 * (s + 2 * plane_x * plane_x));
    y = distorted_y - (kernel.p1 * (s + 2 * plane_y * plane_y) + kernel.p2 * both);
  }
}

// ComputeRay for 'count' pixels, with the best vector instructions, chosen at run time.
void ComputeRays(const RayKernel& kernel, const float* u_px, const float* v_px, std::size_t count,
                 float* x, float* y, float* z);

}  // namespace kestrel
