// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/limits.h"

namespace kestrel {

// The height of a camera above the pattern or the ground for Validate(), m: adds a violation unless
// it is more than 0 and less than 500 m, which UAVs stay far below.
inline void RequireAltitude(double altitude_m, const std::string& key,
                            std::vector<std::string>* violations) {
  constexpr double kLeastWrong = 500;
  Require(altitude_m, Metres{kLeastWrong}, key, violations);
}

// Throws InputError when the height is known and not valid.
inline void RequireAltitude(std::optional<double> altitude_m) {
  std::vector<std::string> violations;
  if (altitude_m) RequireAltitude(*altitude_m, "altitude_m", &violations);
  if (!violations.empty()) throw InputError(violations.front());
}

}  // namespace kestrel
