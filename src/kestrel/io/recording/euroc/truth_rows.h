// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// Rows of a recording's files of truth, from a simulation or a survey.

// The pattern at the time of an image.
struct TruePattern {
  Time time;
  RigidTransform world_from_pattern;
  Eigen::Vector3d velocity_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();  // may lie outside of the image
  double altitude_m = 0;                                // height of the camera above the pattern
  double visible_fraction = 0;  // part of ring and cross within the image, 0 to 1
};

// A thing to follow that is no pad, at the time of an image.
struct TrueRegion {
  Time time;
  // Around what of it would be visible if nothing hid it, within the image: the pixel (x, y) is its
  // upper left one. Empty where it is not in the image.
  cv::Rect2d box_px;
  Eigen::Vector3d place_in_world = Eigen::Vector3d::Zero();  // its foot point on the ground
  Eigen::Vector3d velocity_in_world = Eigen::Vector3d::Zero();
  double visible_fraction = 0;  // 0: hidden
};

// Header and row of state_groundtruth_estimate0/data.csv.
std::string TrueStateHeader();
std::string TrueStateRow(Time time, const RigidTransform& world_from_body,
                         const Eigen::Vector3d& velocity);

// Header and row of landing_pattern0/data.csv.
std::string LandingTruthHeader();
std::string LandingTruthRow(const TruePattern& pattern);

// File, header and row of region0/data.csv; region1 and so on: things that look like it.
std::string RegionTruthFile(std::size_t index);
std::string RegionTruthHeader();
std::string RegionTruthRow(const TrueRegion& region);

}  // namespace kestrel
