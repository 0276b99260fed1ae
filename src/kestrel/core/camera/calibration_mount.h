// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/camera/calibration_entry.h"

namespace kestrel {

// Sets mount, zoom and clock offset from the keys of 'camera' that hold them; 'calibration' has its
// lens. Throws InputError as ReadCalibration does.
void ReadMountAndClock(const CalibrationEntry& camera, CameraCalibration* calibration);

}  // namespace kestrel
