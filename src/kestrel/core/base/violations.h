// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace kestrel {

// Checks for the Validate() of options. Each adds one sentence when 'value' is invalid. NaN is
// always invalid.

inline void RequireIn(double value, double low, double high, const std::string& key,
                      std::vector<std::string>* violations) {
  if (!(value >= low && value <= high)) {
    violations->push_back(fmt::format("{} is {}, expected {} to {}", key, value, low, high));
  }
}

inline void RequireNotNegative(double value, const std::string& key,
                               std::vector<std::string>* violations) {
  if (!(value >= 0 && std::isfinite(value))) {
    violations->push_back(fmt::format("{} is {}, expected 0 or more", key, value));
  }
}

inline void RequirePositive(double value, const std::string& key,
                            std::vector<std::string>* violations) {
  if (!(value > 0 && std::isfinite(value))) {
    violations->push_back(fmt::format("{} is {}, expected more than 0", key, value));
  }
}

inline void RequireFinite(double value, const std::string& key,
                          std::vector<std::string>* violations) {
  if (!std::isfinite(value)) violations->push_back(key + " is not finite");
}

// Adds the violations of a part, each with the part's name before it.
inline void AddViolations(const std::string& part, const std::vector<std::string>& of_part,
                          std::vector<std::string>* violations) {
  for (const std::string& violation : of_part) {
    violations->push_back(fmt::format("{}.{}", part, violation));
  }
}

}  // namespace kestrel
