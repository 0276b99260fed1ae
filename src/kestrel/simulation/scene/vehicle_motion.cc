// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/vehicle_motion.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <Eigen/Geometry>

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

// Straight on, to the other lane and back, softly.
PlanePath LaneChanges(const VehicleMotionOptions& options, const Vector2d& heading) {
  constexpr double kSoftness = 1.5;
  const double rate = 2 * kPi / options.lane_period_s;
  const double reach_m = 0.5 * options.lane_m / std::tanh(kSoftness);
  const Vector2d across(-heading.y(), heading.x());
  return [=](double time_s) {
    const double beside_m = reach_m * std::tanh(kSoftness * std::sin(rate * time_s));
    return Vector2d(options.speed_mps * time_s * heading + beside_m * across);
  };
}

// From 0 to 1, with rest at both ends; its largest slope is 1.875.
double SmoothStep(double part) {
  const double t = std::clamp(part, 0.0, 1.0);
  return t * t * t * (10 + t * (6 * t - 15));
}

// Legs of a square: drives, stops, turns on the spot.
struct Stops {
  static constexpr double kDrive_s = 10;
  static constexpr double kTurn_s = 6;
  static constexpr double kCycle_s = kDrive_s + kTurn_s;

  double leg_m;
  double first_heading;

  double Leg(double time_s) const { return std::floor(time_s / kCycle_s); }
  double Heading(double time_s) const {
    const double turned = SmoothStep((time_s - kCycle_s * Leg(time_s) - kDrive_s) / kTurn_s);
    return first_heading + kPi / 2 * (Leg(time_s) + turned);
  }
  Vector2d Place(double time_s) const {
    const int leg = static_cast<int>(Leg(time_s));
    Vector2d place(0, 0);
    for (int i = 0; i < ((leg % 4) + 4) % 4; ++i) place += leg_m * Along(i);
    const double driven = SmoothStep((time_s - kCycle_s * leg) / kDrive_s);
    return place + driven * leg_m * Along(leg);
  }
  Vector2d Along(int leg) const {
    const double heading = first_heading + kPi / 2 * leg;
    return {std::cos(heading), std::sin(heading)};
  }
};

// Place and heading of the vehicle.
struct Drive {
  PlanePath place;
  std::function<double(double time_s)> heading;
};

// Returns the direction of the motion along a path; 'standing' where it does not move.
std::function<double(double)> HeadingAlong(const PlanePath& path, double standing) {
  return [=](double time_s) {
    constexpr double kStep_s = 5e-3;
    const Vector2d step = path(time_s + kStep_s) - path(time_s - kStep_s);
    return step.norm() > 1e-9 ? std::atan2(step.y(), step.x()) : standing;
  };
}

PlanePath DrivenPath(const VehicleMotionOptions& options, double phase) {
  const double speed = options.speed_mps;
  const double radius = options.radius_m;
  const Vector2d heading(std::cos(phase), std::sin(phase));
  if (options.path == "figure8") return FigureOfEight(radius, speed, phase);
  if (options.path == "lanes") return LaneChanges(options, heading);
  if (options.path == "circle") {
    return [=](double time_s) {
      const double angle = phase + speed / radius * time_s;
      return Vector2d(radius * Vector2d(std::cos(angle), std::sin(angle)));
    };
  }
  const double moving = options.path == "straight" ? speed : 0;
  return [=](double time_s) { return Vector2d(moving * time_s * heading); };
}

Drive DriveOf(const VehicleMotionOptions& options, Random* random) {
  const double phase = random->Uniform(0, 2 * kPi);
  const double standing = random->Uniform(0, 2 * kPi);
  if (options.path == "stops") {
    constexpr double kLargestSlope = 1.875;
    const Stops stops{options.speed_mps * Stops::kDrive_s / kLargestSlope, phase};
    return {[=](double time_s) { return stops.Place(time_s); },
            [=](double time_s) { return stops.Heading(time_s); }};
  }
  const PlanePath path = DrivenPath(options, phase);
  return {path, HeadingAlong(path, standing)};
}

// Heave, roll and pitch on waves.
struct Waves {
  double heave_m;
  double roll;
  double rate;
  double phases[3];

  // Its sides stay above the ground.
  double Heave(double time_s) const {
    constexpr double kHalfWidth_m = 2;
    return 0.5 * heave_m * (1 + std::sin(rate * time_s + phases[0])) + kHalfWidth_m * roll;
  }
  // It rolls more slowly and pitches faster than it heaves.
  double Roll(double time_s) const { return roll * std::sin(rate / 1.2 * time_s + phases[1]); }
  double Pitch(double time_s) const {
    return 0.5 * roll * std::sin(1.1 * rate * time_s + phases[2]);
  }
};

Waves WavesOf(const VehicleMotionOptions& options, Random* random) {
  Waves waves{
      options.heave_m, Radians(options.roll_deg), 2 * kPi / options.heave_period_s, {0, 0, 0}};
  for (double& phase : waves.phases) phase = random->Uniform(0, 2 * kPi);
  return waves;
}

}  // namespace

Motion VehicleMotion(const VehicleMotionOptions& options, Random* random) {
  const Drive drive = DriveOf(options, random);
  const double shake = options.path == "standing" ? 0 : Radians(options.shake_deg);
  const auto roll = Wander(shake, 0.8, random);
  const auto pitch = Wander(shake, 0.6, random);
  const Waves waves = WavesOf(options, random);
  return [=](double time_s) {
    const Vector2d place = drive.place(time_s);
    const Quaterniond rotation =
        AngleAxisd(drive.heading(time_s), Vector3d::UnitZ()) *
        AngleAxisd(pitch(time_s) + waves.Pitch(time_s), Vector3d::UnitY()) *
        AngleAxisd(roll(time_s) + waves.Roll(time_s), Vector3d::UnitX());
    return RigidTransform{rotation, {place.x(), place.y(), waves.Heave(time_s)}};
  };
}

}  // namespace kestrel
