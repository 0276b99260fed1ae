// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/camera/calibration.h"

namespace kestrel {

// Throws InputError when a calibration cannot be written to 'file', as WriteCalibration does:
// before the work for it.
void RequireFreeForCalibration(const std::string& file, bool force);

// Writes a calibration for --camera (a sensor.yaml, with the clock offset if there is one) to
// 'file', or to stdout if that is empty. Throws InputError when the file exists and 'force' is
// false, or when it cannot be written.
void WriteCalibration(const CameraCalibration& calibration, double rate_hz, const std::string& file,
                      bool force);

// The same for the text of another result of a calibration.
void WriteCalibrationText(const std::string& text, const std::string& file, bool force);

}  // namespace kestrel
