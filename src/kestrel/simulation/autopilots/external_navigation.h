// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/core/base/time.h"
#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"
#include "kestrel/simulation/autopilots/autopilot_messages.h"

namespace kestrel {

// The position of an autopilot without GNSS: what ODOMETRY reports, and a drift from there. Which
// messages count, and for how long, as in the sources of ArduCopter 4.7 and PX4 1.18; the filter is
// simpler than theirs.
class ExternalNavigation {
 public:
  // 'parameters' must outlive this.
  ExternalNavigation(AutopilotFirmware firmware, const AutopilotParameters& parameters)
      : firmware_(firmware), parameters_(parameters) {}

  // The position was known until now, by GNSS.
  void BeginKnown(std::int64_t boot_us) { used_us_ = boot_us; }

  // The UAV is at 'place' (ENU, m) now, by the autopilot's own clock.
  void Observe(std::int64_t boot_us, double step_s, const Eigen::Vector3d& place);
  // A message has arrived.
  void Handle(const mavlink::Odometry& message);

  bool has_position() const;
  // Returns what to add to the true place for the estimate, m.
  const Eigen::Vector3d& error() const { return error_; }
  // Returns by how much the last jump moved the estimate, m, once.
  Eigen::Vector3d TakeJump();

 private:
  struct Place {
    std::int64_t boot_us;
    Eigen::Vector3d place;
  };

  bool Uses(const mavlink::Odometry& message) const;
  std::optional<Eigen::Vector3d> PlaceAt(std::int64_t boot_us) const;

  AutopilotFirmware firmware_;
  const AutopilotParameters& parameters_;
  std::deque<Place> places_;  // where it was in the last second
  std::optional<std::int64_t> used_us_;
  std::uint8_t resets_ = 0;
  Eigen::Vector3d error_{0, 0, 0};
  Eigen::Vector3d jump_{0, 0, 0};
};

}  // namespace kestrel
