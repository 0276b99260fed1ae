// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The arithmetic of SmallPatternFitter over all pixels of a print, with the best vector
// instructions of the machine, chosen at run time.

#include <array>
#include <cstddef>

#include "kestrel/vision/landing/small_pattern/small_pattern.h"

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

// Fills the points of the workspace: where each pixel lies on the print and how dark it is there.
void EvaluatePrint(const PrintModel& model, SmallPatternWorkspace* workspace);

// The light on a print, gray values: level of white, its slopes per metre, and white minus black.
struct PrintLight {
  float white;
  float slope_x;
  float slope_y;
  float contrast;
  float highlight;  // gray values above white beyond which a pixel is a highlight
  float saturated;  // gray value from which on the image saturates
};

// Fills 'expected', 'seen', 'residual' and the weights of evaluated points. Residuals beyond
// 'limit' have a weight of less than 1 (Huber's function).
void CompareGrays(const PrintLight& light, float limit, SmallPatternWorkspace* workspace);

// Fills the columns of 'jacobian': derivatives of the expected gray values by the
// SmallPatternWorkspace::kUnknowns unknowns, then the residual, both times the root of their
// weight. PrintAxes: axes of the print in the camera frame.
struct PrintAxes {
  std::array<float, 3> x;
  std::array<float, 3> y;
  std::array<float, 3> normal;
};
void Differentiate(const PrintAxes& axes, float contrast, SmallPatternWorkspace* workspace);

}  // namespace kestrel
