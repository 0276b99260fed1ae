// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/core/base/violations.h"

namespace kestrel {

// The length of a print or an object for Validate(), m: adds a violation unless it is more than 0
// and less than 'least_wrong', from which on the unit was millimetres.
inline void RequireMetres(double value, const std::string& key,
                          std::vector<std::string>* violations, double least_wrong = 20) {
  RequirePositive(value, key, violations);
  if (value >= least_wrong && std::isfinite(value)) {
    constexpr double kMillimetre = 0.001;
    violations->push_back(
        fmt::format("{} is {}, expected metres: {:g}?", key, value, kMillimetre * value));
  }
}

}  // namespace kestrel
