// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace kestrel {

// What a parameter is called by the releases of an autopilot. The first name is the one that
// Kestrel uses for it, and in whose unit its value is told.
struct ParameterNames {
  struct Name {
    std::string_view name;  // empty: there is no more
    double scale = 1;       // value of the first name's parameter over the value of this one
  };
  static constexpr std::size_t kMost = 3;

  std::array<Name, kMost> names;
};

// All names of 'name', which is the first one; only 'name' where there is no other.
ParameterNames NamesOf(std::string_view name);

}  // namespace kestrel
