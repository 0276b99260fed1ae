// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <string>

namespace kestrel {

// A parameter as reported by the autopilot.
struct ReportedParameter {
  double value = 0;      // in the unit of its first name (comms/mavlink/parameter_names.h)
  std::string own_name;  // this autopilot's name for it
  double scale = 1;      // value divided by the value in the autopilot's own unit
};

// The reported parameters by first name.
using ParameterValues = std::map<std::string, ReportedParameter, std::less<>>;

}  // namespace kestrel
