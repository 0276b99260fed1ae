// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace kestrel {

// Lines of TargetShape::outlines, in the plane of the pad, m.

// Returns the line through all corners, with points in between.
std::vector<Eigen::Vector3d> ClosedLine(const std::vector<Eigen::Vector2d>& corners);

// Returns a circle around the origin.
std::vector<Eigen::Vector3d> CircleLine(double radius_m);

}  // namespace kestrel
