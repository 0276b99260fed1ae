// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/base/error.h"
#include "kestrel/simulation/recordings/recording_plan.h"

namespace kestrel {

// Returns the text of one of the plan's files.
inline const std::string& TextOf(const RecordingPlan& plan, const std::string& name) {
  for (const auto& file : plan.files) {
    if (file.name == name) return file.text;
  }
  throw InputError("the plan has no " + name);
}

}  // namespace kestrel
