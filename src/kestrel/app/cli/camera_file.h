// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <fmt/format.h>

#include "kestrel/core/camera/calibration_reader.h"

namespace kestrel {

// Reads a calibration. Says on stderr what of the file is not used.
inline CameraCalibration ReadCameraFile(const std::string& file) {
  return ReadCalibration(
      file, "", [](const std::string& text) { fmt::print(stderr, "kestrel: {}\n", text); });
}

}  // namespace kestrel
