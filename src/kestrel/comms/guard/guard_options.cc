// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/guard/guard_options.h"

#include "kestrel/core/base/violations.h"

namespace kestrel {

std::vector<std::string> GuardOptions::Validate() const {
  std::vector<std::string> violations;
  RequireIn(silence_s, 0.1, 1, "silence_s", &violations);
  return violations;
}

}  // namespace kestrel
