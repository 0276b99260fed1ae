// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/landing_comparison.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kestrel/app/evaluation/projected_circle.h"

namespace kestrel {
namespace {

double TiltOf(const RigidTransform& world_from_body) {
  const Eigen::Vector3d up = world_from_body.rotation * Eigen::Vector3d::UnitZ();
  return std::acos(std::clamp(up.z(), -1.0, 1.0));
}

// The pattern's centre in the image at a time close to that of its row.
std::optional<Eigen::Vector2d> CenterAt(const FlightTruth& flight, const TruePattern& pattern,
                                        Time time) {
  const auto world_from_camera = flight.WorldFromCamera(time);
  if (!world_from_camera) return std::nullopt;
  const Eigen::Vector3d center = pattern.world_from_pattern.translation +
                                 ToSeconds(time - pattern.time) * pattern.velocity_in_world;
  Eigen::Vector2d pixel;
  const ProjectionStatus status =
      flight.camera().Project(world_from_camera->Inverse() * center, &pixel);
  if (status == ProjectionStatus::kOutsideModel) return std::nullopt;
  return pixel;
}

std::optional<double> MotionDuringExposure(const FlightTruth& flight, const TruePattern& pattern) {
  const std::optional<double> exposure_s = flight.scene().ExposureAt(pattern.time);
  if (!exposure_s) return std::nullopt;
  const Duration half = DurationFromSeconds(*exposure_s / 2);
  const auto begin = CenterAt(flight, pattern, pattern.time - half);
  const auto end = CenterAt(flight, pattern, pattern.time + half);
  if (!begin || !end) return std::nullopt;
  return (*end - *begin).norm();
}

// Returns the error of the yaw; nothing where it was not measured, or the pad is unknown.
std::optional<double> YawError(const DetectionRow::Pattern& detected, const TruePattern& truth,
                               std::optional<int> heading_symmetry) {
  constexpr int kQuarters = 4;
  if (!detected.yaw_in_world || !heading_symmetry) return std::nullopt;
  // A pad has one heading by its tags. Without their id only the ring around them was seen.
  const bool only_ring = *heading_symmetry == 1 && !detected.has_id;
  const int symmetry = only_ring ? kQuarters : *heading_symmetry;
  return std::remainder(*detected.yaw_in_world - HeadingOf(truth.world_from_pattern.rotation),
                        2 * std::numbers::pi / symmetry);
}

LandingVerdict Judge(const FlightTruth& flight, const TruePattern* truth,
                     const std::optional<DetectionRow::Pattern>& detected) {
  if (!truth) return detected ? LandingVerdict::kFalse : LandingVerdict::kQuiet;
  if (!detected) return LandingVerdict::kMissed;
  const auto world_from_camera = flight.WorldFromCamera(truth->time);
  const double ring_radius_px =
      world_from_camera ? ProjectedRadius(flight.camera(),
                                          world_from_camera->Inverse() * truth->world_from_pattern,
                                          flight.scene().ring_diameter_m)
                        : 0;
  return IsRightCenter(detected->center_px, truth->center_px, ring_radius_px)
             ? LandingVerdict::kFound
             : LandingVerdict::kFalse;
}

LandingComparison Compare(const FlightTruth& flight, const TruePattern* truth,
                          const DetectionRow& row) {
  LandingComparison comparison;
  comparison.time = row.time;
  comparison.condition = flight.scene().ConditionAt(row.time);
  comparison.verdict = Judge(flight, truth, row.pattern);
  if (row.pattern) comparison.estimate_in_world = row.pattern->center_in_world;
  if (const auto pose = flight.WorldFromBody(row.time)) comparison.tilt = TiltOf(*pose);
  if (!truth) return comparison;
  comparison.truth = *truth;
  comparison.motion_px = MotionDuringExposure(flight, *truth);
  const auto world_from_camera = flight.WorldFromCamera(row.time);
  if (comparison.verdict == LandingVerdict::kFound && world_from_camera) {
    comparison.errors =
        MeasureErrors(*row.pattern, *truth, *world_from_camera, flight.scene().heading_symmetry);
  }
  return comparison;
}

}  // namespace

bool IsRightCenter(const Eigen::Vector2d& detected_px, const Eigen::Vector2d& true_px,
                   double ring_radius_px) {
  return (detected_px - true_px).norm() <= std::max(4.0, 0.15 * ring_radius_px);
}

LandingErrors MeasureErrors(const DetectionRow::Pattern& detected, const TruePattern& truth,
                            const RigidTransform& world_from_camera,
                            std::optional<int> heading_symmetry) {
  const Eigen::Vector3d& true_in_world = truth.world_from_pattern.translation;
  const Eigen::Vector3d true_in_camera = world_from_camera.Inverse() * true_in_world;
  const Eigen::Vector3d error = detected.center_in_camera - true_in_camera;
  const Eigen::Vector3d line_of_sight = true_in_camera.normalized();
  LandingErrors errors;
  errors.center_px = (detected.center_px - truth.center_px).norm();
  errors.depth_m = error.dot(line_of_sight);
  errors.lateral_m = (error - errors.depth_m * line_of_sight).norm();
  errors.nees = error.cwiseQuotient(detected.sigma_in_camera).squaredNorm();
  if (detected.center_in_world) errors.in_world = *detected.center_in_world - true_in_world;
  errors.yaw = YawError(detected, truth, heading_symmetry);
  return errors;
}

std::vector<LandingComparison> CompareLanding(const FlightTruth& flight,
                                              const std::vector<TruePattern>& patterns,
                                              const std::vector<DetectionRow>& rows,
                                              const std::string& file) {
  std::vector<LandingComparison> comparisons;
  for (const DetectionRow& row : rows) {
    flight.RequireFrame(row.time, file);
    comparisons.push_back(Compare(flight, FindTruePattern(patterns, row.time), row));
  }
  return comparisons;
}

}  // namespace kestrel
