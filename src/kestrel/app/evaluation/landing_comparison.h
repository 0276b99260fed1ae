// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/app/evaluation/flight_truth.h"
#include "kestrel/app/evaluation/landing_results.h"
#include "kestrel/app/evaluation/landing_truth.h"

namespace kestrel {

// Errors of a right detection, estimate minus truth.
struct LandingErrors {
  double center_px = 0;
  double lateral_m = 0;  // position in the camera's frame, across the line of sight
  double depth_m = 0;    // along it; positive: too far away
  double nees = 0;       // position in the camera's frame, with the variances of its three axes
  std::optional<Eigen::Vector3d> in_world;
  // rad, to the nearest heading under which what was seen of the pad looks the same: at most an
  // eighth of a turn for the ring, half a turn for tags.
  std::optional<double> yaw;
};

enum class LandingVerdict {
  kFound,   // the pattern is in the scene and was found at its place
  kMissed,  // it is in the scene and was not found
  kFalse,   // something else was detected as the pattern
  kQuiet,   // it is not in the scene, and nothing was found
};

// An image, its result and its truth.
struct LandingComparison {
  Time time;
  std::string condition;
  LandingVerdict verdict = LandingVerdict::kQuiet;
  std::optional<TruePattern> truth;
  std::optional<double> tilt;  // tilt of the UAV: angle between its z axis and the vertical, rad
  std::optional<double> motion_px;  // motion of the pattern's centre during the exposure
  std::optional<Eigen::Vector3d> estimate_in_world;
  std::optional<LandingErrors> errors;  // for kFound only

  // True when the image counts for the rate of success: a quarter of the pattern or more is in
  // view.
  bool IsVisible() const { return truth && truth->visible_fraction >= 0.25; }
};

// True when the detected centre is within 4 px of the true one or, for large rings, 0.15 radii.
bool IsRightCenter(const Eigen::Vector2d& detected_px, const Eigen::Vector2d& true_px,
                   double ring_radius_px);

// 'heading_symmetry': SceneTruth::heading_symmetry.
LandingErrors MeasureErrors(const DetectionRow::Pattern& detected, const TruePattern& truth,
                            const RigidTransform& world_from_camera,
                            std::optional<int> heading_symmetry);

// Returns one comparison per row of 'rows', in order. Throws InputError for a row without an image.
std::vector<LandingComparison> CompareLanding(const FlightTruth& flight,
                                              const std::vector<TruePattern>& patterns,
                                              const std::vector<DetectionRow>& rows,
                                              const std::string& file);

}  // namespace kestrel
