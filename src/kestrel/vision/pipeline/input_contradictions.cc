// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/input_contradictions.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {
namespace {

constexpr std::size_t kLeastDetections = 10;
constexpr double kTolerance = 3;
// Standard deviations of the errors that all detections of a flight may share: of the altitude, of
// the focal length and the size of the print (relative to the distance), of attitude and mount.
constexpr double kAltitudeSigma_m = 0.3;
constexpr double kScaleSigma = 0.04;
constexpr double kAttitudeSigma = Radians(2);
// Largest plausible tilt of the pattern from level.
constexpr double kMaxSlope = Radians(15);
// The altitude may be above the ground, while the pattern is on a vehicle.
constexpr double kMaxVehicleHeight_m = 3;

// Direction out of the pattern's face, in the camera frame.
Eigen::Vector3d Normal(const RigidTransform& camera_from_target) {
  return camera_from_target.rotation * Eigen::Vector3d::UnitZ();
}

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Returns the smaller of the differences of both mirror poses from the given view.
template <class DifferenceOf>
double LeastDifference(const TargetDetection& seen, const DifferenceOf& difference_of) {
  const double value = difference_of(seen.camera_from_target);
  if (!seen.diagnostics.mirror_camera_from_target) return value;
  const double mirrored = difference_of(*seen.diagnostics.mirror_camera_from_target);
  return std::abs(mirrored) < std::abs(value) ? mirrored : value;
}

// Standard deviation of a direction, from the covariance of the rotation.
double AngleSigma(const TargetDetection& seen) {
  return std::sqrt(seen.covariance.bottomRightCorner<3, 3>().trace());
}

}  // namespace

void InputContradictions::Latest::Add(const Difference& difference) {
  if (!std::isfinite(difference.value) || !std::isfinite(difference.sigma)) return;
  differences_[added_++ % kCapacity] = difference;
}

std::optional<Contradiction> InputContradictions::Latest::Median() const {
  if (added_ < kLeastDetections) return std::nullopt;
  const std::size_t count = std::min(added_, kCapacity);
  std::array<double, kCapacity> buffer;
  const auto median = [&](const auto& value_of) {
    std::transform(differences_.begin(), differences_.begin() + count, buffer.begin(), value_of);
    return MedianInPlace(std::span(buffer).first(count));
  };
  const double value = median([](const Difference& each) { return each.value; });
  const double sigma = median([](const Difference& each) { return each.sigma; });
  // For a normal distribution, the standard deviation is 1.48 times the median deviation.
  const double scatter =
      1.48 * median([&](const Difference& each) { return std::abs(each.value - value); });
  return Contradiction{value, std::hypot(sigma, scatter / std::sqrt(count)), count};
}

void InputContradictions::Add(const GivenView& given, const TargetDetection& seen) {
  // Without an attitude the pattern is assumed to be level.
  const auto up_by = [&](const RigidTransform& pose) {
    return given.up_in_camera.value_or(Normal(pose));
  };
  const double up_sigma = given.up_in_camera ? kAttitudeSigma : AngleSigma(seen);
  if (given.up_in_camera) {
    const auto tilt = [&](const RigidTransform& pose) {
      return AngleBetween(Normal(pose), *given.up_in_camera);
    };
    tilts_.Add({LeastDifference(seen, tilt), std::hypot(AngleSigma(seen), kAttitudeSigma)});
  }
  if (!given.altitude_m) return;
  const auto excess_m = [&](const RigidTransform& pose) {
    return *given.altitude_m + up_by(pose).dot(pose.translation);
  };
  const RigidTransform& pose = seen.camera_from_target;
  const double aside_m = up_by(pose).cross(pose.translation).norm();
  const double position_variance = seen.covariance.topLeftCorner<3, 3>().trace();
  const double shared_m = std::hypot(kAltitudeSigma_m, kScaleSigma * pose.translation.norm());
  altitudes_.Add({LeastDifference(seen, excess_m),
                  std::hypot(shared_m, up_sigma * aside_m, std::sqrt(position_variance))});
}

std::optional<Contradiction> InputContradictions::Attitude() const {
  const std::optional<Contradiction> tilt = tilts_.Median();
  if (!tilt || tilt->difference <= kMaxSlope + kTolerance * tilt->sigma) return std::nullopt;
  return tilt;
}

std::optional<Contradiction> InputContradictions::Altitude() const {
  if (Attitude()) return std::nullopt;
  const std::optional<Contradiction> excess = altitudes_.Median();
  if (!excess) return std::nullopt;
  const double most_m = tilts_.empty() ? 0 : kMaxVehicleHeight_m;
  const double tolerance_m = kTolerance * excess->sigma;
  const bool agrees =
      excess->difference >= -tolerance_m && excess->difference <= most_m + tolerance_m;
  return agrees ? std::nullopt : excess;
}

}  // namespace kestrel
