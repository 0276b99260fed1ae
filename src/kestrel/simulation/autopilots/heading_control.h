// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "kestrel/simulation/autopilots/set_point_reading.h"

namespace kestrel {

// Heading control of an autopilot: it turns in proportion to the angle that is left, adds the rate
// that is fed forward, and has a fastest turn.
class HeadingControl {
 public:
  // 'gain': 1/s; 'max_rate': rad/s.
  HeadingControl(double gain, double max_rate) : gain_(gain), max_rate_(max_rate) {}

  // Begins anew with the heading that the UAV has at the next Step.
  void Reset() { heading_.reset(); }

  // Returns the heading after this step towards 'yaw', which turns at 'rate'; rad and rad/s from
  // east to north.
  double Step(double yaw, double rate, const FlightState& state) {
    if (!heading_) heading_ = HeadingOf(state);
    const double left = std::remainder(yaw - *heading_, 2 * std::numbers::pi);
    *heading_ += std::clamp(gain_ * left + rate, -max_rate_, max_rate_) * state.step_s;
    return *heading_;
  }

 private:
  double gain_;
  double max_rate_;
  std::optional<double> heading_;
};

}  // namespace kestrel
