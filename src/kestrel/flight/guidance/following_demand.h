// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/flight/guidance/flight_limits.h"
#include "kestrel/flight/guidance/flight_model.h"

namespace kestrel {

// Part of the UAV's limits that following the target takes; 1 is all of it.
struct FollowingDemand {
  double lean_deg = 0, max_lean_deg = 0;
  double speed_mps = 0, max_speed_mps = 0;
  double climb_mps = 0, max_climb_mps = 0;

  double lean_share() const;  // share of the acceleration at the largest lean
  double speed_share() const;
  double climb_share() const;
  // True when the UAV cannot follow however it flies.
  bool is_beyond_limits() const;
  // Returns what is beyond the limits ("54 degrees of lean, the limit is 35"); empty when nothing
  // is.
  std::string InWords() const;
};

// Watches what the target's motion and the wind demand. The demand of a curve is kept for a while
// after it: a figure of eight demands it again and again.
class DemandWatch {
 public:
  explicit DemandWatch(const FlightLimitsOptions& limits) : limits_(limits) {}

  // Takes the target's velocity and acceleration at 'now', in order of time. 'air': drag and wind,
  // where they are known. Returns the largest recent demand.
  const FollowingDemand& Update(Time now, const Eigen::Vector3d& velocity,
                                const Eigen::Vector3d& acceleration,
                                const std::optional<AirEstimate>& air);
  void Reset();

  const FollowingDemand& demand() const { return demand_; }

 private:
  FlightLimitsOptions limits_;
  std::optional<Time> time_;
  double acceleration_ = 0;       // smoothed, m/s^2: its direction turns with the target
  double acceleration_peak_ = 0;  // m/s^2
  double speed_peak_ = 0, climb_peak_ = 0;
  FollowingDemand demand_;
};

}  // namespace kestrel
