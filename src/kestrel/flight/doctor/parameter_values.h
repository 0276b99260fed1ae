// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <string>

namespace kestrel {

// A parameter as the autopilot told it.
struct ToldParameter {
  double value = 0;      // in the unit of its first name (link/parameter_names.h)
  std::string own_name;  // what this autopilot calls it
  double scale = 1;      // value over that of the autopilot's own unit
};

// By first name, those that were told.
using ParameterValues = std::map<std::string, ToldParameter, std::less<>>;

}  // namespace kestrel
