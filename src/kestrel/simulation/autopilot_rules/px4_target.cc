// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilot_rules/px4_target.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/ned.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kRememberedPoses = 512;
constexpr std::uint64_t kOldestVision_us = 500'000;

Time OwnInstant(std::int64_t own_us) { return TimeFromNanoseconds(1000 * own_us); }

}  // namespace

Px4Target::Px4Target(const AutopilotParameters& parameters, const Px4TimeSync& clock,
                     Announce announce)
    : parameters_(parameters),
      clock_(clock),
      announce_(std::move(announce)),
      poses_(kRememberedPoses, std::chrono::seconds(1)) {}

void Px4Target::Handle(const mavlink::LandingTarget& target, const FlightState& state) {
  // PX4 passes angles to a driver that the vision target estimator replaces.
  if (target.position_valid == 0) return;
  if (target.frame != mavlink::kFrameLocalNed) {
    announce_(Severity::kCritical,
              fmt::format("landing target: coordinate frame {} unsupported", target.frame));
    return;
  }
  if (uses_vision_estimator()) return;
  const Vector3d place = EnuFromNed({target.x, target.y, target.z});
  if (!place.allFinite()) return;
  place_ = Place{place, {0, 0}, clock_.OwnTime(target.time_usec, state.boot_us)};
  is_updated_ = true;
}

void Px4Target::Handle(const mavlink::TargetRelative& target, const FlightState& state) {
  constexpr int kUsesVision = 2;  // bit of VTE_AID_MASK
  if (!uses_vision_estimator()) return;
  if ((static_cast<int>(parameters_["VTE_AID_MASK"]) & kUsesVision) == 0) return;
  const auto own_us = static_cast<std::uint64_t>(state.boot_us);
  if (target.timestamp > own_us || own_us - target.timestamp > kOldestVision_us) {
    constexpr std::int64_t kReportEvery_us = 3'000'000;
    if (state.boot_us - reported_old_us_ < kReportEvery_us) return;
    reported_old_us_ = state.boot_us;
    announce_(Severity::kWarning, "VTE: Vision data too old!");
    return;
  }
  const Time seen = OwnInstant(static_cast<std::int64_t>(target.timestamp));
  const auto place = InWorld(target, poses_.Lookup(seen).value_or(state.pose.world_from_body));
  const Vector3d sigma(target.pos_std[0], target.pos_std[1], target.pos_std[2]);
  if (place && place->allFinite() && sigma.allFinite()) Fuse(*place, sigma, state);
}

// Returns the target in the world, seen from the pose that the body had then.
std::optional<Vector3d> Px4Target::InWorld(const mavlink::TargetRelative& target,
                                           const RigidTransform& world_from_body) const {
  const Vector3d sent(target.x, target.y, target.z);
  if (target.frame == mavlink::kTargetFrameBodyFrd) return world_from_body * FluFromFrd(sent);
  if (target.frame == mavlink::kTargetFrameOther) {
    const Eigen::Quaterniond ned_from_sensor(target.q_sensor[0], target.q_sensor[1],
                                             target.q_sensor[2], target.q_sensor[3]);
    if (std::abs(ned_from_sensor.norm() - 1) > 0.01) return std::nullopt;
    return world_from_body.translation + EnuFromNed(ned_from_sensor * sent);
  }
  return world_from_body.translation + EnuFromNed(sent);
}

void Px4Target::Fuse(const Vector3d& in_world, const Vector3d& sigma, const FlightState& state) {
  constexpr double kLeastVariance = 1e-4;
  constexpr double kMaxRatio = 3.84;     // 95 % of one axis
  constexpr int kMaxOutliersInARow = 3;  // in a row; a longer series is not an outlier
  constexpr std::int64_t kTimeout_us = 2'000'000;
  if (!is_filtering_ || state.boot_us - fused_us_ > kTimeout_us) {
    for (int i = 0; i < 3; ++i) filters_[i].Start(in_world[i], 1, 0, 1);
    is_filtering_ = true;
    fused_us_ = state.boot_us;
  }
  const Vector3d variance = sigma.cwiseAbs2().cwiseMax(kLeastVariance);
  double ratio = 0;
  for (int i = 0; i < 3; ++i) {
    ratio = std::max(ratio, filters_[i].InnovationRatio(in_world[i], variance[i]));
  }
  if (ratio > kMaxRatio && outliers_ < kMaxOutliersInARow) {
    ++outliers_;
    return;
  }
  outliers_ = 0;
  fused_us_ = state.boot_us;
  for (int i = 0; i < 3; ++i) filters_[i].Fuse(in_world[i], variance[i]);
}

void Px4Target::Estimate(const FlightState& state) {
  constexpr double kTargetNoise = 0.02;  // m/s, per root of a second
  PoseSample pose = state.pose;
  pose.time = OwnInstant(state.boot_us);
  poses_.Add(pose);
  if (!is_filtering_ || !uses_vision_estimator()) return;
  Vector3d position;
  for (int i = 0; i < 3; ++i) {
    filters_[i].Predict(state.step_s, 0, kTargetNoise * std::sqrt(state.step_s));
    position[i] = filters_[i].position();
  }
  place_ = Place{position, {filters_[0].velocity(), filters_[1].velocity()}, fused_us_};
  is_updated_ = true;
}

bool Px4Target::TakeUpdated() { return std::exchange(is_updated_, false); }

}  // namespace kestrel
