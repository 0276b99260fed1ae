// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/simulated_pilot.h"

#include <algorithm>

#include "kestrel/core/base/options.h"
#include "kestrel/simulation/autopilot_rules/landing_rules.h"

namespace kestrel {

using Eigen::Vector3d;

SimulatedPilot::SimulatedPilot(const PilotOptions& options, const VehicleWorld& world, Time start)
    : options_(Checked(options)), world_(world), start_(start) {}

Vector3d SimulatedPilot::PlaceAt(Time now) const {
  return world_.PatternAt(now).translation +
         Vector3d(options_.offset_east_m, options_.offset_north_m, options_.start_altitude_m);
}

SetPoint SimulatedPilot::FollowVehicle(Time now, const Vector3d& position) const {
  constexpr double kGain = 1;
  constexpr double kBraking = 2.5;
  constexpr double kMax_mps = 5;
  constexpr double kMaxClimb_mps = 1.5;
  const Vector3d way = PlaceAt(now) - position;
  SetPoint command;
  command.velocity = world_.VelocityAt(now);
  command.velocity.head<2>() += BrakingVelocity(way.head<2>(), kGain, kBraking, kMax_mps);
  command.velocity.z() = std::clamp(kGain * way.z(), -kMaxClimb_mps, kMaxClimb_mps);
  return command;
}

std::optional<FlightMode> SimulatedPilot::Switch(Time now, bool flies) {
  constexpr Duration kBetweenTries = std::chrono::milliseconds(500);
  const double since_s = ToSeconds(now - start_);
  const auto is_over = [&](double after_s) { return after_s >= 0 && since_s >= after_s; };
  if (took_back_) return std::nullopt;
  if (is_over(options_.take_back_after_s)) {
    took_back_ = true;
    return FlightMode::kPilot;
  }
  if (!flies) return std::nullopt;
  if (options_.guide_after_s >= 0) {
    if (!is_over(options_.guide_after_s) || now < next_try_) return std::nullopt;
    next_try_ = now + kBetweenTries;
    return FlightMode::kGuided;
  }
  if (is_over(options_.land_after_s)) return FlightMode::kPrecisionLand;
  return std::nullopt;
}

bool SimulatedPilot::LosesBattery(Time now) {
  const double after_s = options_.battery_failsafe_after_s;
  if (has_low_battery_ || after_s < 0 || ToSeconds(now - start_) < after_s) return false;
  has_low_battery_ = true;
  return true;
}

}  // namespace kestrel
