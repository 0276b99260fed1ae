// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <fmt/format.h>

namespace kestrel {

// Returns a value with this number of decimals, for people: what rounds to zero has no sign.
inline std::string Fixed(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

}  // namespace kestrel
