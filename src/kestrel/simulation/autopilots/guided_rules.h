// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/simulation/autopilot_rules/landing_rules.h"

namespace kestrel {

// Flight of an autopilot by external set-points (ArduPilot's GUIDED, PX4's OFFBOARD): which ones it
// accepts, how it follows them, and what it does when they stop. Internally ENU and FLU.
class GuidedRules {
 public:
  virtual ~GuidedRules() = default;

  // Takes a set-point, in any mode.
  virtual void Handle(const mavlink::SetPositionTargetLocalNed& message, const FlightState& state,
                      bool is_guided) = 0;

  // Takes an attitude with a climb rate, in any mode.
  virtual void Handle(const mavlink::SetAttitudeTarget& message, const FlightState& state,
                      bool is_guided) = 0;

  // True when the mode may begin.
  virtual bool IsAvailable(const FlightState& state) const = 0;
  // True when its set-points, by the newest one, need a position.
  virtual bool NeedsPosition() const { return true; }
  // Called when the mode begins.
  virtual void Start(const FlightState& state) = 0;
  // One step of the mode. Returns the command to fly.
  virtual FlightCommand Fly(const FlightState& state) = 0;
  // Returns the mode that it enters now because there are no set-points any more; nothing: it
  // stays.
  virtual std::optional<FlightMode> LossAction(const FlightState& state) const = 0;
};

}  // namespace kestrel
