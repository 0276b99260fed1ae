// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "kestrel/base/time.h"
#include "kestrel/geometry/rigid_transform.h"

namespace kestrel {

// A row of landing_pattern0/data.csv: where the pattern was when an image was taken.
struct TruePattern {
  Time time;
  RigidTransform world_from_pattern;
  Eigen::Vector3d velocity_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();  // may lie outside of the image
  double altitude_m = 0;                                // of the camera above the pattern
  double visible_fraction = 0;  // part of ring and cross that the image shows
};

// Rows in order of time. Throws InputError with file and line for what is at fault.
std::vector<TruePattern> ParseTruePatterns(std::string_view text, const std::string& file);

// The row of that very time, if there is one.
const TruePattern* FindTruePattern(const std::vector<TruePattern>& patterns, Time time);

// Position and velocity at any time between two rows that are at most half a second apart, by the
// cubic through both positions and velocities.
struct TrueMotion {
  Eigen::Vector3d position_in_world;
  Eigen::Vector3d velocity_in_world;
};
std::optional<TrueMotion> TrueMotionAt(const std::vector<TruePattern>& patterns, Time time);

}  // namespace kestrel
