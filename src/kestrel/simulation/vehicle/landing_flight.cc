// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/vehicle/landing_flight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/vehicle/multicopter_motion.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

}  // namespace

Motion LandingFlight(const LandingFlightOptions& options, const Path& target, double duration_s,
                     Random* random) {
  // Two sways across each other, with periods that coincide only rarely.
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
    constexpr double kHalfSwayAltitude_m = 1;  // about: less room for swaying further down
    const double part = std::clamp(time_s / duration_s, -0.1, 1.1);
    // Exponential: it takes as long from 2 to 1 m as from 8 to 4 m.
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
