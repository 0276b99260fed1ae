// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

namespace kestrel {

inline constexpr int kEdgeProfile = 11;  // gray values across an edge

// Returns the place of a rising edge in a profile over -reach to reach: the centroid of the
// gradient around its steepest place. NaN where there is none.
double EdgePlace(std::span<const float, kEdgeProfile> gray, double reach);

}  // namespace kestrel
