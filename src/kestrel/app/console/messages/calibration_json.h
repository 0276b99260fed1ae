// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "kestrel/app/console/messages/calibration_state.h"

namespace kestrel {

// Returns the message "calibration" for the page, as defined in web/src/calibration.ts.
nlohmann::json CalibrationJson(const ConsoleCalibration& calibration);

}  // namespace kestrel
