// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/flight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "kestrel/geometry/angles.h"
#include "kestrel/simulation/violations.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kStep_s = 5e-3;  // of the differences that give velocity and acceleration

using PlanePath = std::function<Vector2d(double time_s)>;

// Bernoulli's lemniscate, 2 radius long. The sine keeps the speed the same to a few percent; over
// a whole round the curve is 5.244 radius long.
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

// Unit vector of the motion, or nothing to divide by: 'standing' where it does not move.
Vector2d Heading(const PlanePath& path, double time_s, const Vector2d& standing) {
  const Vector2d step = path(time_s + kStep_s) - path(time_s - kStep_s);
  const double length = step.norm();
  return length > 1e-9 ? Vector2d(step / length) : standing;
}

Vector3d Acceleration(const Path& position, double time_s) {
  return (position(time_s + kStep_s) - 2 * position(time_s) + position(time_s - kStep_s)) /
         (kStep_s * kStep_s);
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

std::vector<std::string> LandingFlightOptions::Validate() const {
  std::vector<std::string> violations;
  RequireIn(start_altitude_m, 0.1, 100, "start_altitude_m", &violations);
  RequireIn(end_altitude_m, 0.1, 100, "end_altitude_m", &violations);
  RequireIn(offset_m, 0, 3, "offset_m", &violations);
  RequireIn(sway_acceleration, 0, 15, "sway_acceleration", &violations);
  RequireIn(sway_period_s, 0.5, 60, "sway_period_s", &violations);
  RequireIn(attitude_noise_deg, 0, 10, "attitude_noise_deg", &violations);
  RequireIn(yaw_rate_deg, 0, 360, "yaw_rate_deg", &violations);
  return violations;
}

std::function<double(double)> Wander(double sigma, double period_s, Random* random) {
  constexpr int kSines = 4;
  std::array<double, kSines> rates{};
  std::array<double, kSines> phases{};
  for (int i = 0; i < kSines; ++i) {
    rates[i] = 2 * kPi / (period_s * random->Uniform(0.6, 1.6));
    phases[i] = random->Uniform(0, 2 * kPi);
  }
  const double amplitude = sigma * std::sqrt(2.0 / kSines);
  return [=](double time_s) {
    double sum = 0;
    for (int i = 0; i < kSines; ++i) sum += std::sin(rates[i] * time_s + phases[i]);
    return amplitude * sum;
  };
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

Motion LandingFlight(const LandingFlightOptions& options, const Path& target, double duration_s,
                     Random* random) {
  // Two sways across each other, of periods that do not meet again soon.
  constexpr double kPeriodRatio = 0.8;
  const double rate_x = 2 * kPi / options.sway_period_s;
  const double rate_y = kPeriodRatio * rate_x;
  const double acceleration = options.sway_acceleration / std::numbers::sqrt2;
  const double phase = random->Uniform(0, 2 * kPi);
  constexpr double kDriftPeriod_s = 12;
  const auto beside_x = Wander(options.offset_m / std::numbers::sqrt2, kDriftPeriod_s, random);
  const auto beside_y = Wander(options.offset_m / std::numbers::sqrt2, kDriftPeriod_s, random);
  const double ratio = options.end_altitude_m / options.start_altitude_m;
  const Path position = [=](double time_s) {
    constexpr double kHalfSwayAltitude_m = 1;  // about: less room to sway further down
    const double part = std::clamp(time_s / duration_s, -0.1, 1.1);
    // As long at 1 to 2 m as at 4 to 8 m.
    const double altitude = options.start_altitude_m * std::pow(ratio, part);
    const double sway = acceleration * altitude / std::hypot(altitude, kHalfSwayAltitude_m);
    const double sway_x = sway / (rate_x * rate_x) * std::sin(rate_x * time_s);
    const double sway_y = sway / (rate_y * rate_y) * std::sin(rate_y * time_s + phase);
    return Vector3d(target(time_s) + Vector3d(altitude * beside_x(time_s) + sway_x,
                                              altitude * beside_y(time_s) + sway_y, altitude));
  };
  const double turn = random->Uniform(0, 2 * kPi);
  constexpr double kTurnPeriod_s = 8;
  const auto turning =
      Wander(Radians(options.yaw_rate_deg) * kTurnPeriod_s / (2 * kPi), kTurnPeriod_s, random);
  const auto yaw = [=](double time_s) { return turn + turning(time_s); };
  return MulticopterMotion(position, yaw, options.attitude_noise_deg, random);
}

}  // namespace kestrel
