// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/vehicle/navigation_model.h"

#include <cmath>

#include <Eigen/Geometry>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/vehicle/flight_time.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Vector3d NormalVector(double sigma, Random* random) {
  const double x = random->Normal();
  const double y = random->Normal();
  return sigma * Vector3d(x, y, random->Normal());
}

}  // namespace

std::vector<std::string> NavigationOptions::Validate() const {
  std::vector<std::string> violations;
  Require(clock_offset_max_s, Range{clock_offset_min_s, 10}, "clock_offset_max_s", &violations);
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

NavigationSensor::NavigationSensor(const NavigationOptions& options, const NavigationErrors& errors,
                                   Random random)
    : options_(options),
      errors_(errors),
      random_(random),
      navigation_from_world_{
          Quaterniond(AngleAxisd(Radians(options.world_yaw_deg), Vector3d::UnitZ())),
          {options.origin_x_m, options.origin_y_m, 0}} {
  constexpr double kDriftPeriod_s = 40;
  bias_ = NormalVector(options.position_bias_m, &random_);
  turn_ = RotationBy(NormalVector(Radians(options.attitude_bias_deg), &random_));
  for (auto& drift : drift_) drift = Wander(options.position_drift_m, kDriftPeriod_s, &random_);
}

PoseSample NavigationSensor::Report(double time_s, RigidTransform world_from_body) {
  world_from_body = navigation_from_world_ * world_from_body;
  const Vector3d drift(drift_[0](time_s), drift_[1](time_s), drift_[2](time_s));
  world_from_body.translation += bias_ + drift + NormalVector(options_.position_noise_m, &random_);
  const Vector3d noise = NormalVector(Radians(options_.attitude_noise_deg), &random_);
  world_from_body.rotation = (world_from_body.rotation * turn_ * RotationBy(noise)).normalized();
  return {TimeOfFlight(time_s + errors_.clock_offset_s), world_from_body};
}

std::vector<PoseSample> NavigationSensor::ReportAll(const Motion& world_from_body, double begin_s,
                                                    double end_s) {
  std::vector<PoseSample> poses;
  const int count = static_cast<int>(std::ceil((end_s - begin_s) * options_.rate_hz)) + 1;
  for (int i = 0; i < count; ++i) {
    const double time_s = begin_s + i / options_.rate_hz;
    poses.push_back(Report(time_s, world_from_body(time_s)));
  }
  return poses;
}

std::function<Quaterniond(double)> Vibration(const NavigationOptions& options, Random* random) {
  const double sigma = Radians(options.vibration_deg);
  const double period_s = 1 / options.vibration_hz;
  const auto x = Wander(sigma, period_s, random);
  const auto y = Wander(sigma, period_s, random);
  const auto z = Wander(sigma, period_s, random);
  return [=](double time_s) { return RotationBy(Vector3d(x(time_s), y(time_s), z(time_s))); };
}

}  // namespace kestrel
