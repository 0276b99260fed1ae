// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/assumed_lens.h"

#include <cmath>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {

CameraIntrinsics AssumedLens(int width_px, int height_px, double fov_deg) {
  constexpr double kWidestPinhole_deg = 100;
  const bool is_pinhole = fov_deg <= kWidestPinhole_deg;
  const double half = Radians(fov_deg / 2);
  const double focal_px = width_px / 2.0 / (is_pinhole ? std::tan(half) : half);
  CameraIntrinsics lens;
  lens.width_px = width_px;
  lens.height_px = height_px;
  lens.fx_px = focal_px;
  lens.fy_px = focal_px;
  lens.cx_px = 0.5 * (width_px - 1);
  lens.cy_px = 0.5 * (height_px - 1);
  if (!is_pinhole) {
    lens.distortion_model = DistortionModel::kEquidistant;
    lens.distortion = {0, 0, 0, 0};
  }
  return lens;
}

}  // namespace kestrel
