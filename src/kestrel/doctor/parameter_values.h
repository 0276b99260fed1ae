// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace kestrel {

// Parameters of an autopilot by name, as far as it told them.
using ParameterValues = std::map<std::string, double, std::less<>>;

}  // namespace kestrel
