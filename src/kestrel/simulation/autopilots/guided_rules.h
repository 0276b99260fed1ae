// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/comms/autopilot_rules/landing_rules.h"
#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/comms/mavlink/messages.h"

namespace kestrel {

// How an autopilot flies by set-points from outside (ArduPilot's GUIDED, PX4's OFFBOARD): which of
// them it takes, what it makes of them, and what it does when they end. Internally ENU and FLU.
class GuidedRules {
 public:
  virtual ~GuidedRules() = default;

  // A set-point came, in whatever mode it flies.
  virtual void Handle(const mavlink::SetPositionTargetLocalNed& message, const FlightState& state,
                      bool is_guided) = 0;

  // Whether the mode may begin.
  virtual bool IsAvailable(const FlightState& state) const = 0;
  // The mode begins.
  virtual void Start(const FlightState& state) = 0;
  // One step of it: how to fly.
  virtual FlightCommand Fly(const FlightState& state) = 0;
  // To which mode it goes now because there are no set-points any more; nothing: it stays.
  virtual std::optional<FlightMode> LossAction(const FlightState& state) const = 0;
};

}  // namespace kestrel
