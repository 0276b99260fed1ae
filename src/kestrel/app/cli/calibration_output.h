// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/camera/calibration.h"

namespace kestrel {

// Writes a calibration that --camera reads (a sensor.yaml, with the clock offset if there is one)
// to 'file', or to stdout where that is empty. Throws InputError when the file is there and 'force'
// is off, or cannot be written.
void WriteCalibration(const CameraCalibration& calibration, double rate_hz, const std::string& file,
                      bool force);

}  // namespace kestrel
