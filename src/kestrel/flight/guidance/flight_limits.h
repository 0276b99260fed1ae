// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/poses/set_point.h"

namespace kestrel {

// Volume in which guidance may fly, and its speeds. The defaults are within the default limits of
// ArduCopter and PX4.
struct FlightLimitsOptions {
  double geofence_radius_m = 100;
  double ceiling_m = 30;
  double floor_m = 3;
  double max_speed_mps = 10;
  double max_climb_mps = 2.5;
  double max_sink_mps = 1.5;
  double max_tilt_deg = 30;

  static void Visit(auto& self, auto&& visit) {
    visit("geofence_radius_m", self.geofence_radius_m, Range{1, 10000},
          "distance from home, at most");
    visit("ceiling_m", self.ceiling_m, Range{1, 1000}, "largest height above the world's z = 0");
    visit("floor_m", self.floor_m, "smallest height without a followed target");
    visit("max_speed_mps", self.max_speed_mps, Range{0.5, 50}, "largest horizontal speed");
    visit("max_climb_mps", self.max_climb_mps, Range{0.2, 20}, "fastest climb");
    visit("max_sink_mps", self.max_sink_mps, Range{0.2, 20}, "fastest descent");
    visit("max_tilt_deg", self.max_tilt_deg, Range{1, 80},
          "largest tilt that a commanded acceleration may require");
  }
  std::vector<std::string> Validate() const;

  double max_acceleration() const;  // horizontal acceleration at the largest tilt, m/s^2
};

// The autopilot's own limits, as far as its parameters are known: it does not follow commands
// beyond them.
struct AutopilotLimits {
  std::optional<double> max_speed_mps = std::nullopt;  // horizontal
  std::optional<double> max_climb_mps = std::nullopt;
  std::optional<double> max_sink_mps = std::nullopt;
  std::optional<double> max_tilt_deg = std::nullopt;
};

// Returns one line for each limit that exceeds the autopilot's own limit.
std::vector<std::string> ViolationsOf(const AutopilotLimits& autopilot,
                                      const FlightLimitsOptions& limits);

// Limits all set-points; nothing else does. No allocation, no throw.
class FlightLimits {
 public:
  // 'center' of the geofence, in the world, m. Throws InputError when the options are not valid.
  FlightLimits(const FlightLimitsOptions& options, const Eigen::Vector2d& center);

  // Returns one line with the reason why guidance must not begin with the body at 'position'
  // (outside the geofence, above the ceiling); empty when it may. Allocates only when it may not.
  std::string WhyNot(const Eigen::Vector3d& position) const;
  bool Contains(const Eigen::Vector3d& position) const;

  // Returns 'wanted', limited for a body at 'position': it can still brake before the geofence, the
  // ceiling and, without a target, the floor. Beyond one of them the body is brought back.
  SetPoint Limited(const SetPoint& wanted, const Eigen::Vector3d& position,
                   bool follows_target) const;

  void set_center(const Eigen::Vector2d& center) { center_ = center; }
  const FlightLimitsOptions& options() const { return options_; }

 private:
  void LimitHeight(double z_m, bool follows_target, SetPoint* limited) const;
  void KeepInFence(const Eigen::Vector2d& position, SetPoint* limited) const;

  FlightLimitsOptions options_;
  Eigen::Vector2d center_;
  double max_acceleration_;  // m/s^2
};

}  // namespace kestrel
