// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/cli/calibration_output.h"

#include <filesystem>
#include <iostream>

#include <fmt/format.h>

#include "kestrel/recording/euroc_text.h"
#include "kestrel/recording/output_folder.h"

namespace kestrel {

void WriteCalibration(const CameraCalibration& calibration, double rate_hz, const std::string& file,
                      bool force) {
  std::string text = EurocCameraText(calibration, rate_hz);
  if (calibration.clock_offset) {
    text += fmt::format("timeshift_cam_imu: {}\n", ToSeconds(*calibration.clock_offset));
  }
  if (file.empty()) {
    std::cout << text << std::flush;
    return;
  }
  const std::filesystem::path path(file);
  OutputFolder(path.has_parent_path() ? path.parent_path() : ".", force).OpenText(path.filename())
      << text;
}

}  // namespace kestrel
