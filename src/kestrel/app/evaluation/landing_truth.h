// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/io/recording/euroc/truth_rows.h"

namespace kestrel {

// Returns the rows in order of time. Throws InputError with file and line for what is not valid.
std::vector<TruePattern> ParseTruePatterns(std::string_view text, const std::string& file);

// Returns the row of exactly this time; null when there is none.
const TruePattern* FindTruePattern(const std::vector<TruePattern>& patterns, Time time);

// True position and velocity, interpolated between two rows that are at most half a second apart by
// the cubic through both positions and velocities.
struct TrueMotion {
  Eigen::Vector3d position_in_world;
  Eigen::Vector3d velocity_in_world;
};
std::optional<TrueMotion> TrueMotionAt(const std::vector<TruePattern>& patterns, Time time);

}  // namespace kestrel
