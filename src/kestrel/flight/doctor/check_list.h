// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace kestrel {

// A check of Check(), in words.
struct ListedCheck {
  std::string_view name;   // as in Finding
  std::string_view wants;  // good is so
};

// Returns all checks but those of parameters (CheckedParameters), in the order of Check().
std::span<const ListedCheck> ListedChecks();

// Returns a table of all checks and parameters, one per line.
std::string CheckTable();

}  // namespace kestrel
