// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/flight_limits.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Speed to a boundary, or back from beyond it, per metre of distance. With it an autopilot with
// half a second of lag does not overshoot.
constexpr double kBoundaryGain = 0.7;
constexpr double kBrakingPart = 0.5;  // part of the largest acceleration, for braking before a
                                      // boundary

// Largest speed towards a boundary 'distance_m' away (less than 0: beyond it).
double SpeedTowards(double distance_m, double braking) {
  const double slow = kBoundaryGain * distance_m;
  return distance_m > 0 ? std::min(slow, std::sqrt(2 * braking * distance_m)) : slow;
}

void RequireWithin(double own, const std::optional<double>& autopilot, const char* key,
                   const char* unit, std::vector<std::string>* violations) {
  // A tenth of a per cent allows for the rounding of a parameter that is a float.
  if (!autopilot || own <= 1.001 * *autopilot) return;
  violations->push_back(fmt::format("limits.{} is {:g} {}, the autopilot's own limit is {:g} {}",
                                    key, own, unit, *autopilot, unit));
}

}  // namespace

std::vector<std::string> FlightLimitsOptions::Validate() const {
  std::vector<std::string> violations;
  Require(floor_m, Range{0, ceiling_m}, "floor_m", &violations);
  return violations;
}

double FlightLimitsOptions::max_acceleration() const {
  return kGravity * std::tan(Radians(max_tilt_deg));
}

std::vector<std::string> ViolationsOf(const AutopilotLimits& autopilot,
                                      const FlightLimitsOptions& limits) {
  std::vector<std::string> violations;
  RequireWithin(limits.max_speed_mps, autopilot.max_speed_mps, "max_speed_mps", "m/s", &violations);
  RequireWithin(limits.max_climb_mps, autopilot.max_climb_mps, "max_climb_mps", "m/s", &violations);
  RequireWithin(limits.max_sink_mps, autopilot.max_sink_mps, "max_sink_mps", "m/s", &violations);
  RequireWithin(limits.max_tilt_deg, autopilot.max_tilt_deg, "max_tilt_deg", "deg", &violations);
  return violations;
}

FlightLimits::FlightLimits(const FlightLimitsOptions& options, const Vector2d& center)
    : options_(Checked(options)), center_(center), max_acceleration_(options.max_acceleration()) {}

bool FlightLimits::Contains(const Vector3d& position) const {
  return (position.head<2>() - center_).norm() <= options_.geofence_radius_m &&
         position.z() <= options_.ceiling_m;
}

std::string FlightLimits::WhyNot(const Vector3d& position) const {
  const double distance_m = (position.head<2>() - center_).norm();
  if (!(distance_m <= options_.geofence_radius_m)) {
    return fmt::format(
        "the UAV is {:.1f} m from the middle of the geofence, limits.geofence_radius_m is {:g}",
        distance_m, options_.geofence_radius_m);
  }
  if (!(position.z() <= options_.ceiling_m)) {
    return fmt::format("the UAV is {:.1f} m high, limits.ceiling_m is {:g}", position.z(),
                       options_.ceiling_m);
  }
  return {};
}

SetPoint FlightLimits::Limited(const SetPoint& wanted, const Vector3d& position,
                               bool follows_target) const {
  SetPoint limited = wanted;
  const double tilt = limited.acceleration.head<2>().norm();
  if (tilt > max_acceleration_) limited.acceleration.head<2>() *= max_acceleration_ / tilt;
  const double speed = limited.velocity.head<2>().norm();
  if (speed > options_.max_speed_mps) {
    limited.velocity.head<2>() *= options_.max_speed_mps / speed;
  }
  limited.velocity.z() =
      std::clamp(limited.velocity.z(), -options_.max_sink_mps, options_.max_climb_mps);
  LimitHeight(position.z(), follows_target, &limited);
  KeepInFence(position.head<2>(), &limited);
  return limited;
}

void FlightLimits::LimitHeight(double z_m, bool follows_target, SetPoint* limited) const {
  double& climb = limited->velocity.z();
  climb = std::min(climb, std::max(SpeedTowards(options_.ceiling_m - z_m, max_acceleration_),
                                   -options_.max_sink_mps));
  if (follows_target) return;
  climb = std::max(climb, std::min(-SpeedTowards(z_m - options_.floor_m, max_acceleration_),
                                   options_.max_climb_mps));
}

// Limits the outward velocity to what can be braked; the part along the fence stays.
void FlightLimits::KeepInFence(const Vector2d& position, SetPoint* limited) const {
  const Vector2d from_center = position - center_;
  const double distance_m = from_center.norm();
  if (!(distance_m > 0)) return;
  const Vector2d outwards = from_center / distance_m;
  const double allowed = std::max(
      SpeedTowards(options_.geofence_radius_m - distance_m, kBrakingPart * max_acceleration_),
      -options_.max_speed_mps);
  const double excess = limited->velocity.head<2>().dot(outwards) - allowed;
  if (excess <= 0) return;
  limited->velocity.head<2>() -= excess * outwards;
  const double push = std::max(limited->acceleration.head<2>().dot(outwards), 0.0);
  limited->acceleration.head<2>() -= push * outwards;
}

}  // namespace kestrel
