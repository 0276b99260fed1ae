// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The calibration of a camera: its lens, its mount on the body and the offset of its clock.
//
// Example:
//   CameraCalibration calibration;
//   calibration.intrinsics = {
//       .width_px = 640, .height_px = 480, .fx_px = 400, .fy_px = 400, .cx_px = 320, .cy_px = 240};
//   calibration.clock_offset = std::chrono::milliseconds(20);

#include "kestrel/core/camera/calibration.h"  // IWYU pragma: export
