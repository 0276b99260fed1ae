// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <fmt/format.h>

#include "kestrel/core/camera/calibration_reader.h"

namespace kestrel {

inline void PrintUnusedKeys(const std::string& text) { fmt::print(stderr, "kestrel: {}\n", text); }

// Reads a calibration. Reports on stderr which keys of the file are not used.
inline CameraCalibration ReadCameraFile(const std::string& file) {
  return ReadCalibration(file, "", PrintUnusedKeys);
}

}  // namespace kestrel
