// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/vehicle/gimbal_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/vehicle/flight_time.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kSteps_hz = 400;

// Returns the angles that look along 'ray'. Near the vertical the yaw is that of the body: it
// would turn around with every step aside.
GimbalAngles AnglesTo(const Vector3d& ray, double heading) {
  constexpr double kSteep = Radians(70.0);
  const double pitch = std::atan2(-ray.z(), ray.head<2>().norm());
  if (pitch > kSteep) return {heading, kPi / 2};
  return {std::atan2(ray.y(), ray.x()), pitch};
}

// Returns the difference to 'angle' on the shorter way.
double Turn(double from, double to) { return std::remainder(to - from, 2 * kPi); }

}  // namespace

GimbalAngles Turned(const GimbalMotorOptions& motors, const GimbalAngles& angles,
                    const GimbalAngles& aim, double seconds) {
  const double most = Radians(motors.max_turn_dps) * seconds;
  const double part = seconds / (motors.lag_s + seconds);
  return {angles.yaw + std::clamp(part * Turn(angles.yaw, aim.yaw), -most, most),
          angles.pitch + std::clamp(part * (aim.pitch - angles.pitch), -most, most)};
}

Quaterniond WithNoise(const GimbalMotorOptions& motors, const Quaterniond& rotation,
                      Random* random) {
  const double x = random->Normal();
  const double y = random->Normal();
  const Vector3d noise = Radians(motors.noise_deg) * Vector3d(x, y, random->Normal());
  return (rotation * RotationBy(noise)).normalized();
}

SimulatedGimbal::SimulatedGimbal(const GimbalOptions& options, Motion world_from_body,
                                 const RigidTransform& body_from_pivot, const Path& target,
                                 double begin_s, double end_s)
    : options_(options),
      world_from_body_(std::move(world_from_body)),
      body_from_pivot_(body_from_pivot),
      begin_s_(begin_s) {
  const double step_s = 1 / kSteps_hz;
  const auto wanted = [&](double time_s) {
    const RigidTransform world_from_pivot = world_from_body_(time_s) * body_from_pivot_;
    return AnglesTo(target(time_s) - world_from_pivot.translation,
                    HeadingOf(world_from_pivot.rotation));
  };
  GimbalAngles angles = wanted(begin_s);
  for (double time_s = begin_s; time_s <= end_s + step_s; time_s += step_s) {
    angles_.push_back(angles);
    angles = Turned(options, angles, wanted(time_s), step_s);
  }
}

Quaterniond SimulatedGimbal::Attitude(double time_s) const {
  const double at =
      std::clamp((time_s - begin_s_) * kSteps_hz, 0.0, static_cast<double>(angles_.size() - 1));
  const auto before = std::min(static_cast<std::size_t>(at), angles_.size() - 2);
  const double part = at - static_cast<double>(before);
  const GimbalAngles& from = angles_[before];
  const GimbalAngles& to = angles_[before + 1];
  return GimbalAngles{from.yaw + part * (to.yaw - from.yaw),
                      from.pitch + part * (to.pitch - from.pitch)}
      .rotation();
}

RigidTransform SimulatedGimbal::WorldFromPlatform(double time_s) const {
  return {Attitude(time_s), world_from_body_(time_s) * body_from_pivot_.translation};
}

double SimulatedGimbal::end_s() const {
  return begin_s_ + static_cast<double>(angles_.size() - 1) / kSteps_hz;
}

std::vector<GimbalSample> SimulatedGimbal::Truth(double rate_hz) const {
  std::vector<GimbalSample> truth;
  for (double time_s = begin_s_; time_s <= end_s(); time_s += 1 / rate_hz) {
    truth.push_back({TimeOfFlight(time_s), Attitude(time_s), YawFrame::kEarth});
  }
  return truth;
}

std::vector<GimbalSample> SimulatedGimbal::Reports(double clock_offset_s, double world_yaw_rad,
                                                   Random random) const {
  const YawFrame frame = options_.yaw_frame == "earth" ? YawFrame::kEarth : YawFrame::kVehicle;
  std::vector<GimbalSample> reports;
  for (double time_s = begin_s_; time_s <= end_s(); time_s += 1 / options_.rate_hz) {
    const double turn = frame == YawFrame::kEarth
                            ? world_yaw_rad
                            : -HeadingOf((world_from_body_(time_s) * body_from_pivot_).rotation);
    const Quaterniond attitude(AngleAxisd(turn, Vector3d::UnitZ()) * Attitude(time_s));
    reports.push_back({TimeOfFlight(time_s + clock_offset_s + options_.stamp_delay_s),
                       WithNoise(options_, attitude, &random), frame});
  }
  return reports;
}

}  // namespace kestrel
