// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The arithmetic of SmallPatternFitter over all pixels of a print, with the best instructions of
// the machine at run time.

#include <array>
#include <cstddef>

#include "kestrel/vision/landing/small_pattern.h"

namespace kestrel {

// A blurred print under a pose.
struct PrintModel {
  std::array<float, 9> plane_from_ray;  // ray to homogeneous coordinates of the plane, row by row
  float blur_px;                        // standard deviation
  float inner_radius_m;
  float outer_radius_m;
  float arm_half_width_m;
  float arm_half_length_m;
};

// Where the pixels lie on the print and how dark it is there: fills the points.
void EvaluatePrint(const PrintModel& model, SmallPatternWorkspace* workspace);

// The light on a print, gray values: white with slopes per metre, and white minus black.
struct PrintLight {
  float white;
  float slope_x;
  float slope_y;
  float contrast;
  float highlight;  // what exceeds white by more is no white
  float saturated;  // gray value from which on the image cuts off what is brighter
};

// What is expected and seen of evaluated points: fills 'expected', 'seen', 'residual', and the
// weights, which are less than 1 (Huber's function) for residuals beyond 'limit'.
void CompareGrays(const PrintLight& light, float limit, SmallPatternWorkspace* workspace);

// Derivatives of the expected gray values, and the residuals, both times the root of their weight:
// fills the columns of 'jacobian' by SmallPatternWorkspace::kUnknowns and the residual. Axes of the
// print in the camera frame.
struct PrintAxes {
  std::array<float, 3> x;
  std::array<float, 3> y;
  std::array<float, 3> normal;
};
void Differentiate(const PrintAxes& axes, float contrast, SmallPatternWorkspace* workspace);

}  // namespace kestrel
