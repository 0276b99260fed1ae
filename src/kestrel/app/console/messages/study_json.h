// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "kestrel/app/console/messages/study_state.h"

namespace kestrel {

// Messages for the page, as defined in web/src/study.ts.
nlohmann::json Message(const ConsoleStudy& study);
nlohmann::json Message(const ConsoleStudyReplay& replay);

}  // namespace kestrel
