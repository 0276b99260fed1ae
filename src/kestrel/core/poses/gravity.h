// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace kestrel {

inline constexpr double kGravity = 9.81;  // m/s^2, downwards

}  // namespace kestrel
