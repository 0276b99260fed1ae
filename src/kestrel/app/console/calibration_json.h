// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "kestrel/app/console/calibration_report.h"

namespace kestrel {

// The message "calibration" of the page, as web/src/calibration.ts has it.
nlohmann::json CalibrationJson(const ConsoleCalibration& calibration);

}  // namespace kestrel
