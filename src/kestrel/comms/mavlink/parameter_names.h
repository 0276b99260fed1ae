// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace kestrel {

// The names of a parameter in the releases of an autopilot. Kestrel uses the first name, and values
// in its unit.
struct ParameterNames {
  struct Name {
    std::string_view name;  // empty: no further name
    double scale = 1;       // value in the first name's unit divided by the value in this name's
                            // unit
  };
  static constexpr std::size_t kMost = 3;

  std::array<Name, kMost> names;
};

// Returns all names of 'name', which is a first name; only 'name' where there is no other.
ParameterNames NamesOf(std::string_view name);

}  // namespace kestrel
