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

// Errors of a detection of the right thing, estimate minus truth.
struct LandingErrors {
  double center_px = 0;
  double lateral_m = 0;  // of the position in the camera, across the line of sight
  double depth_m = 0;    // along it; positive: too far away
  double nees = 0;       // of the position in the camera, with the variances of its three axes
  std::optional<Eigen::Vector3d> in_world;
  std::optional<double> yaw;  // within an eighth of a turn: the pattern repeats every quarter
};

enum class LandingVerdict {
  kFound,   // the pattern is in the scene and was found where it is
  kMissed,  // it is in the scene and was not found
  kFalse,   // something else was taken for it
  kQuiet,   // it is not in the scene, and nothing was found
};

// One image, its result and its truth.
struct LandingComparison {
  Time time;
  std::string condition;
  LandingVerdict verdict = LandingVerdict::kQuiet;
  std::optional<TruePattern> truth;
  std::optional<double> tilt;       // of the UAV: angle between its z axis and the vertical
  std::optional<double> motion_px;  // of the pattern's centre during the exposure
  std::optional<Eigen::Vector3d> estimate_in_world;
  std::optional<LandingErrors> errors;  // of what was found

  // Whether the image counts for the rate of success: at least a quarter of the pattern is in view.
  bool IsVisible() const { return truth && truth->visible_fraction >= 0.25; }
};

// Whether a detected centre is the true one: to 4 px or, for large rings, 0.15 radii of the ring.
bool IsRightCenter(const Eigen::Vector2d& detected_px, const Eigen::Vector2d& true_px,
                   double ring_radius_px);

LandingErrors MeasureErrors(const DetectionRow::Pattern& detected, const TruePattern& truth,
                            const RigidTransform& world_from_camera);

// One for every row of 'rows', in order. Throws InputError for a row that is of no image.
std::vector<LandingComparison> CompareLanding(const FlightTruth& flight,
                                              const std::vector<TruePattern>& patterns,
                                              const std::vector<DetectionRow>& rows,
                                              const std::string& file);

}  // namespace kestrel
