// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/navigation_model.h"

#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "kestrel/simulation/flight.h"
#include "kestrel/simulation/recording_plan.h"
#include "kestrel/simulation/violations.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

double Radians(double degrees) { return degrees * std::numbers::pi / 180; }

Vector3d NormalVector(double sigma, Random* random) {
  const double x = random->Normal();
  const double y = random->Normal();
  return sigma * Vector3d(x, y, random->Normal());
}

Quaterniond SmallTurn(const Vector3d& turn) {
  const double angle = turn.norm();
  return angle > 0 ? Quaterniond(AngleAxisd(angle, turn / angle)) : Quaterniond::Identity();
}

}  // namespace

std::vector<std::string> NavigationOptions::Validate() const {
  std::vector<std::string> violations;
  RequireIn(rate_hz, 1, 1000, "rate_hz", &violations);
  RequireIn(position_noise_m, 0, 10, "position_noise_m", &violations);
  RequireIn(position_drift_m, 0, 10, "position_drift_m", &violations);
  RequireIn(position_bias_m, 0, 10, "position_bias_m", &violations);
  RequireIn(attitude_noise_deg, 0, 10, "attitude_noise_deg", &violations);
  RequireIn(attitude_bias_deg, 0, 10, "attitude_bias_deg", &violations);
  RequireIn(clock_offset_min_s, -10, 10, "clock_offset_min_s", &violations);
  RequireIn(clock_offset_max_s, clock_offset_min_s, 10, "clock_offset_max_s", &violations);
  RequireIn(mount_error_deg, 0, 20, "mount_error_deg", &violations);
  RequireIn(vibration_deg, 0, 5, "vibration_deg", &violations);
  RequireIn(vibration_hz, 1, 500, "vibration_hz", &violations);
  return violations;
}

NavigationErrors DrawNavigationErrors(const NavigationOptions& options, Random* random) {
  NavigationErrors errors;
  errors.clock_offset_s = random->Uniform(options.clock_offset_min_s, options.clock_offset_max_s);
  errors.mount_roll_deg = options.mount_error_deg * random->Normal();
  errors.mount_pitch_deg = options.mount_error_deg * random->Normal();
  errors.mount_yaw_deg = options.mount_error_deg * random->Normal();
  return errors;
}

RigidTransform NavigationErrors::TrueMount(const RigidTransform& nominal) const {
  const Quaterniond turn = AngleAxisd(Radians(mount_yaw_deg), Vector3d::UnitZ()) *
                           AngleAxisd(Radians(mount_pitch_deg), Vector3d::UnitY()) *
                           AngleAxisd(Radians(mount_roll_deg), Vector3d::UnitX());
  return {(turn * nominal.rotation).normalized(), nominal.translation};
}

std::vector<PoseSample> ReportedPoses(const NavigationOptions& options,
                                      const NavigationErrors& errors, const Motion& world_from_body,
                                      double begin_s, double end_s, Random* random) {
  constexpr double kDriftPeriod_s = 40;
  const Vector3d bias = NormalVector(options.position_bias_m, random);
  const Quaterniond turn = SmallTurn(NormalVector(Radians(options.attitude_bias_deg), random));
  const auto drift_x = Wander(options.position_drift_m, kDriftPeriod_s, random);
  const auto drift_y = Wander(options.position_drift_m, kDriftPeriod_s, random);
  const auto drift_z = Wander(options.position_drift_m, kDriftPeriod_s, random);
  std::vector<PoseSample> poses;
  const int count = static_cast<int>(std::ceil((end_s - begin_s) * options.rate_hz)) + 1;
  for (int i = 0; i < count; ++i) {
    const double time_s = begin_s + i / options.rate_hz;
    RigidTransform pose = world_from_body(time_s);
    pose.translation += bias + Vector3d(drift_x(time_s), drift_y(time_s), drift_z(time_s)) +
                        NormalVector(options.position_noise_m, random);
    const Vector3d noise = NormalVector(Radians(options.attitude_noise_deg), random);
    pose.rotation = (pose.rotation * turn * SmallTurn(noise)).normalized();
    poses.push_back({TimeOfFlight(time_s + errors.clock_offset_s), pose});
  }
  return poses;
}

std::function<Quaterniond(double)> Vibration(const NavigationOptions& options, Random* random) {
  const double sigma = Radians(options.vibration_deg);
  const double period_s = 1 / options.vibration_hz;
  const auto x = Wander(sigma, period_s, random);
  const auto y = Wander(sigma, period_s, random);
  const auto z = Wander(sigma, period_s, random);
  return [=](double time_s) { return SmallTurn(Vector3d(x(time_s), y(time_s), z(time_s))); };
}

}  // namespace kestrel
