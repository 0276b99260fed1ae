// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The error that all of Kestrel throws for invalid input: one line that names the file, key or row
// and says what was expected.
//
// Example:
//   try {
//     const CameraCalibration calibration = ReadCalibration("camera.yaml");
//   } catch (const InputError& error) {
//     std::cerr << error.what() << "\n";  // one line: file, line, what was expected
//   }

#include "kestrel/core/base/error.h"  // IWYU pragma: export
