// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "kestrel/app/console/messages/lens_state.h"

namespace kestrel {

// Returns the message of a guided calibration, as web/src/lens.ts reads it.
nlohmann::json Message(const ConsoleLens& lens);

}  // namespace kestrel
