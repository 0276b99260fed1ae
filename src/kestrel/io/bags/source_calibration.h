// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "kestrel/core/camera/calibration.h"
#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

// Returns the calibration of the file, or the source's own where 'file' is empty; nothing if it has
// none. 'camera': which one of a file with several, as ReadCalibration. Calls 'notify' with the
// keys of either file that are not used. Throws as ReadCalibration.
std::optional<CameraCalibration> CalibrationOf(
    const FrameSource& source, const std::string& file,
    const std::function<void(const std::string&)>& notify, const std::string& camera = "");

}  // namespace kestrel
