// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "kestrel/app/console/messages/color_state.h"

namespace kestrel {

// Messages for the page, as defined in web/src/color_protocol.ts.
nlohmann::json Message(const ConsoleColors& colors);
nlohmann::json Message(const ConsoleColorScores& scores);

}  // namespace kestrel
