// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "kestrel/calibration/lens/lens_fit.h"
#include "kestrel/core/camera/camera_model.h"

namespace kestrel {

// Projects a point in the camera frame to a pixel as CameraModel::Project does, for automatic
// differentiation. 'parameters': kLensParameters values. Returns false when the lens does not show
// the point.
template <class T>
bool ProjectThroughLens(DistortionModel model, const T* parameters, const T* point, T* pixel) {
  using std::atan2;
  using std::sqrt;
  const T* k = parameters + kDistortion;
  T x, y;
  if (model == DistortionModel::kEquidistant) {
    constexpr double kTiny = 1e-18;  // keeps the derivative on the axis finite
    const T radius = sqrt(point[0] * point[0] + point[1] * point[1] + kTiny);
    const T theta = atan2(radius, point[2]);
    const T s = theta * theta;
    const T distorted = theta * (1.0 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3]))));
    x = distorted / radius * point[0];
    y = distorted / radius * point[1];
  } else {
    if (!(point[2] > 1e-6)) return false;
    const T a = point[0] / point[2], b = point[1] / point[2];
    const T s = a * a + b * b;
    const T radial = 1.0 + s * (k[0] + s * (k[1] + s * k[4]));
    x = a * radial + 2.0 * k[2] * a * b + k[3] * (s + 2.0 * a * a);
    y = b * radial + k[2] * (s + 2.0 * b * b) + 2.0 * k[3] * a * b;
  }
  pixel[0] = parameters[kFocal] * x + parameters[kPrincipalX];
  pixel[1] = parameters[kFocal] * parameters[kAspect] * y + parameters[kPrincipalY];
  return true;
}

}  // namespace kestrel
