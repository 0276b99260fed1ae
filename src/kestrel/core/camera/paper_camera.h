// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/camera/camera_model.h"

namespace kestrel {

// The fisheye camera of the paper (section 2.1): 752x480, equidistant, 185 degrees (DSL215).
inline CameraIntrinsics PaperCamera() {
  return {.width_px = 752,
          .height_px = 480,
          .fx_px = 261,
          .fy_px = 261,
          .cx_px = 376,
          .cy_px = 240,
          .distortion_model = DistortionModel::kEquidistant,
          .distortion = {-0.0448, 0.0686053, -0.072277, 0.027011955}};
}

}  // namespace kestrel
