// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/vehicle/multicopter_motion.h"

#include <cmath>

#include <Eigen/Geometry>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Vector3d Acceleration(const Path& position, double time_s) {
  constexpr double kStep_s = 5e-3;
  return (position(time_s + kStep_s) - 2 * position(time_s) + position(time_s - kStep_s)) /
         (kStep_s * kStep_s);
}

}  // namespace

Quaterniond MulticopterAttitude(const Vector3d& thrust, double yaw) {
  const Vector3d up = thrust.normalized();
  const Vector3d left = up.cross(Vector3d(std::cos(yaw), std::sin(yaw), 0)).normalized();
  Eigen::Matrix3d axes;
  axes << left.cross(up), left, up;
  return Quaterniond(axes);
}

Motion MulticopterMotion(const Path& position, const std::function<double(double)>& yaw,
                         double attitude_noise_deg, Random* random) {
  const double noise = Radians(attitude_noise_deg);
  const auto roll = Wander(noise, 0.5, random);
  const auto pitch = Wander(noise, 0.5, random);
  return [=](double time_s) {
    const Vector3d thrust = Acceleration(position, time_s) + kGravity * Vector3d::UnitZ();
    const Quaterniond rotation = MulticopterAttitude(thrust, yaw(time_s)) *
                                 AngleAxisd(pitch(time_s), Vector3d::UnitY()) *
                                 AngleAxisd(roll(time_s), Vector3d::UnitX());
    return RigidTransform{rotation.normalized(), position(time_s)};
  };
}

}  // namespace kestrel
