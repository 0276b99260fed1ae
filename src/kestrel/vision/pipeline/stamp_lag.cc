// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/stamp_lag.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "kestrel/vision/pipeline/camera_lag.h"

namespace kestrel {
namespace {

constexpr Duration kLeastSpacing = std::chrono::milliseconds(45);
constexpr Duration kWindow = std::chrono::milliseconds(3500);
constexpr double kEarliest_s = -0.3, kLatest_s = 0.5, kStep_s = 0.05;
constexpr std::size_t kLeastSightings = 15;
// Coefficients of the path's polynomial: a car on a curve fits one of third order for seconds.
constexpr int kTerms = 4;
// Least excess of the weighted squares. The errors of neighbouring sightings are alike, so that it
// is more than a normal distribution would need.
constexpr double kLeastExcess = 40;

// Returns the pose at a time; nothing where it is predicted.
std::optional<RigidTransform> KnownPose(const CameraPoses& poses, Time time) {
  const auto pose = poses.At(time);
  if (!pose || pose->uncertainty.position_m > 0) return std::nullopt;
  return pose->world_from_camera;
}

}  // namespace

void StampLag::Add(Time time, const Eigen::Vector3d& center_in_camera, double sigma_m) {
  const bool is_dense =
      added_ > 0 && time - sightings_[(added_ - 1) % kCapacity].time < kLeastSpacing;
  if (is_dense || !(sigma_m > 0)) return;
  sightings_[added_++ % kCapacity] = {time, center_in_camera, sigma_m};
}

StampLag::Usable StampLag::WithPoses(const CameraPoses& poses) const {
  Usable usable;
  if (added_ == 0) return usable;
  const Time newest = sightings_[(added_ - 1) % kCapacity].time;
  for (std::size_t i = 0; i < std::min(added_, kCapacity); ++i) {
    const Sighting& sighting = sightings_[i];
    if (newest - sighting.time > kWindow ||
        !KnownPose(poses, sighting.time - DurationFromSeconds(kEarliest_s)) ||
        !KnownPose(poses, sighting.time - DurationFromSeconds(kLatest_s))) {
      continue;
    }
    usable.sightings[usable.count++] = &sighting;
  }
  return usable;
}

// Returns the weighted squares of the horizontal distances from a smooth path.
double StampLag::Misfit(const Usable& usable, double lag_s, const CameraPoses& poses) const {
  const Duration lag = DurationFromSeconds(lag_s);
  const Sighting& first = *usable.sightings[0];
  Eigen::Matrix<double, kTerms, kTerms> normal = Eigen::Matrix<double, kTerms, kTerms>::Zero();
  Eigen::Matrix<double, kTerms, 2> moments = Eigen::Matrix<double, kTerms, 2>::Zero();
  std::optional<Eigen::Vector2d> origin;
  double squares = 0;
  for (std::size_t i = 0; i < usable.count; ++i) {
    const Sighting& sighting = *usable.sightings[i];
    const auto pose = KnownPose(poses, sighting.time - lag);
    if (!pose) return std::numeric_limits<double>::infinity();
    const Eigen::Vector2d place = (*pose * sighting.center_in_camera).head<2>();
    if (!origin) origin = place;
    const Eigen::Vector2d from_origin = place - *origin;
    const double t = ToSeconds(sighting.time - first.time);
    const Eigen::Vector4d powers(1, t, t * t, t * t * t);
    const double weight = 1 / (sighting.sigma_m * sighting.sigma_m);
    normal += weight * powers * powers.transpose();
    moments += weight * powers * from_origin.transpose();
    squares += weight * from_origin.squaredNorm();
  }
  return squares - moments.cwiseProduct(normal.ldlt().solve(moments)).sum();
}

std::optional<double> StampLag::Contradiction(const CameraPoses& poses) const {
  const Usable usable = WithPoses(poses);
  if (usable.count < kLeastSightings) return std::nullopt;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double best = kInfinity, best_lag_s = 0, best_tolerated = kInfinity;
  constexpr int kSteps = static_cast<int>((kLatest_s - kEarliest_s) / kStep_s + 0.5);
  for (int i = 0; i <= kSteps; ++i) {
    const double lag_s = kEarliest_s + i * kStep_s;
    const double misfit = Misfit(usable, lag_s, poses);
    if (misfit < best) {
      best = misfit;
      best_lag_s = lag_s;
    }
    if (std::abs(lag_s) < CameraLag::kLongest_s + kStep_s / 2) {
      best_tolerated = std::min(best_tolerated, misfit);
    }
  }
  // A least at an end of the range is none: something else than the stamps is wrong there.
  if (best_lag_s < kEarliest_s + kStep_s / 2 || best_lag_s > kLatest_s - kStep_s / 2) {
    return std::nullopt;
  }
  const double freedom = 2.0 * (static_cast<double>(usable.count) - kTerms) - 1;
  const double variance = std::max(best / freedom, 1.0);
  if (!(best_tolerated - best > kLeastExcess * variance)) return std::nullopt;
  return best_lag_s;
}

}  // namespace kestrel
