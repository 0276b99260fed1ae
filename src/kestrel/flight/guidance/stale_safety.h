// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Core>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/poses/set_point.h"

namespace kestrel {

// Behaviour of the autopilot with a set-point after which no other comes. `fly` reads it from the
// autopilot's parameters.
struct StaleOptions {
  double timeout_s = 0.3;
  double vertical_braking = 1;
  double vertical_jerk = 5;
  double position_gain = 0;
  double height_gain = 0;

  static void Visit(auto& self, auto&& visit) {
    visit("timeout_s", self.timeout_s, Range{0, 60}, "time that the last set-point is flown on");
    visit("vertical_braking", self.vertical_braking, Range{0.1, 20}, "[m/s^2] deceleration then");
    visit("vertical_jerk", self.vertical_jerk, Range{0.1, 1000}, "[m/s^3] its jerk");
    visit("position_gain", self.position_gain, Range{0, 5},
          "[1/s] the autopilot's speed per metre to a place; 0: velocities are sent");
    visit("height_gain", self.height_gain, Range{0, 5}, "[1/s] the same for the height");
  }

  bool sends_places() const { return position_gain > 0 && height_gain > 0; }
};

// Makes every set-point one that may be the last: the UAV then stops, above the deck.
//
// Velocities (ArduCopter's GUIDED): the autopilot flies the velocity v on for the time-out T and
// then brakes with the deceleration a and the jerk j. The way down is v T + v^2 / 2 a + v a / 2 j.
//
// Places (PX4's OFFBOARD): the position control flies with v = K (place - position). Whatever
// velocity and place add up to v, the UAV comes to rest at v / K from where it is, time-out or not.
// With a place alone there is no velocity to continue after the time-out.
class StaleSafety {
 public:
  explicit StaleSafety(const StaleOptions& options) : options_(options) {}

  // Returns the fastest descent (m/s, positive) at 'height_m' of the feet above the deck from which
  // the UAV comes to rest above the deck. 'link_delay_s': time from sending to the effect.
  double MaxSink(double height_m, double link_delay_s) const;

  // Sets the place of a set-point whose velocity is wanted, for a body at 'position' with
  // 'velocity', where the autopilot takes places.
  void SetPlace(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity,
                double link_delay_s, SetPoint* set_point) const;

  // Returns 'set_point' without its descent, and without acceleration.
  SetPoint Level(SetPoint set_point) const;

 private:
  StaleOptions options_;
};

}  // namespace kestrel
