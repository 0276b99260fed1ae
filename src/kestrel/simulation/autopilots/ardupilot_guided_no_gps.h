// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/core/base/time.h"
#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"
#include "kestrel/simulation/autopilots/guided_rules.h"
#include "kestrel/simulation/autopilots/set_point_reading.h"

namespace kestrel {

// ArduCopter's GUIDED_NOGPS: an attitude and a climb rate, and nothing else. Other than in GUIDED,
// a set-point that it does not accept changes nothing: the old lean is flown until GUID_TIMEOUT.
class ArduPilotGuidedNoGps : public GuidedRules {
 public:
  // The parameters must outlive this.
  explicit ArduPilotGuidedNoGps(const AutopilotParameters& parameters) : parameters_(parameters) {}

  void Handle(const mavlink::SetPositionTargetLocalNed& /*message*/, const FlightState& /*state*/,
              bool /*is_guided*/) override {}
  void Handle(const mavlink::SetAttitudeTarget& message, const FlightState& state,
              bool is_guided) override;
  bool IsAvailable(const FlightState& /*state*/) const override { return true; }
  bool NeedsPosition() const override { return false; }
  void Start(const FlightState& state) override;
  FlightCommand Fly(const FlightState& state) override;
  std::optional<FlightMode> LossAction(const FlightState& /*state*/) const override {
    return std::nullopt;
  }

 private:
  const AutopilotParameters& parameters_;
  AttitudeOrder order_;
  Time reported_{};
};

}  // namespace kestrel
