// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/vehicle_motion.h"

#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "kestrel/core/base/violations.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

using PlanePath = std::function<Vector2d(double time_s)>;

// Bernoulli's lemniscate, 2 radius long. The sine keeps the speed constant within a few percent; a
// whole round is 5.244 radius long.
PlanePath FigureOfEight(double radius_m, double speed_mps, double phase) {
  const double rate = 2 * kPi * speed_mps / (5.2441 * radius_m);
  return [=](double time_s) {
    const double even = phase + rate * time_s;
    const double angle = even - 0.086 * std::sin(2 * even);
    const double sine = std::sin(angle);
    return Vector2d(radius_m * std::cos(angle) / (1 + sine * sine) * Vector2d(1, sine));
  };
}

PlanePath DrivenPath(const VehicleMotionOptions& options, Random* random) {
  const double phase = random->Uniform(0, 2 * kPi);
  const double speed = options.speed_mps;
  const double radius = options.radius_m;
  if (options.path == "figure8") return FigureOfEight(radius, speed, phase);
  if (options.path == "circle") {
    return [=](double time_s) {
      const double angle = phase + speed / radius * time_s;
      return Vector2d(radius * Vector2d(std::cos(angle), std::sin(angle)));
    };
  }
  const double moving = options.path == "straight" ? speed : 0;
  const Vector2d heading(std::cos(phase), std::sin(phase));
  return [=](double time_s) { return Vector2d(moving * time_s * heading); };
}

// Returns the unit vector of the motion; 'standing' where it does not move.
Vector2d Heading(const PlanePath& path, double time_s, const Vector2d& standing) {
  constexpr double kStep_s = 5e-3;
  const Vector2d step = path(time_s + kStep_s) - path(time_s - kStep_s);
  const double length = step.norm();
  return length > 1e-9 ? Vector2d(step / length) : standing;
}

}  // namespace

std::vector<std::string> VehicleMotionOptions::Validate() const {
  std::vector<std::string> violations;
  if (path != "standing" && path != "straight" && path != "circle" && path != "figure8") {
    violations.push_back(
        fmt::format("path is '{}', expected standing, straight, circle or figure8", path));
  }
  RequireIn(speed_mps, 0, 20, "speed_mps", &violations);
  RequireIn(radius_m, 2, 500, "radius_m", &violations);
  RequireIn(shake_deg, 0, 10, "shake_deg", &violations);
  return violations;
}

Motion VehicleMotion(const VehicleMotionOptions& options, Random* random) {
  const PlanePath path = DrivenPath(options, random);
  const double turn = random->Uniform(0, 2 * kPi);
  const Vector2d standing(std::cos(turn), std::sin(turn));
  const double shake = options.path == "standing" ? 0 : Radians(options.shake_deg);
  const auto roll = Wander(shake, 0.8, random);
  const auto pitch = Wander(shake, 0.6, random);
  return [=](double time_s) {
    const Vector2d place = path(time_s);
    const Vector2d heading = Heading(path, time_s, standing);
    const Quaterniond rotation =
        AngleAxisd(std::atan2(heading.y(), heading.x()), Vector3d::UnitZ()) *
        AngleAxisd(pitch(time_s), Vector3d::UnitY()) * AngleAxisd(roll(time_s), Vector3d::UnitX());
    return RigidTransform{rotation, {place.x(), place.y(), 0}};
  };
}

}  // namespace kestrel
