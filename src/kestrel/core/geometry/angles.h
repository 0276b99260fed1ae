// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

namespace kestrel {

inline constexpr double kPi = std::numbers::pi;

constexpr double Radians(double degrees) { return degrees * kPi / 180; }
constexpr double Degrees(double radians) { return radians * 180 / kPi; }

}  // namespace kestrel
