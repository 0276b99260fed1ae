// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/guidance/flight_limits.h"
#include "kestrel/flight/guidance/guidance_options.h"

namespace kestrel {

// Asks for the parameters that the functions below need.
void WantGuidanceParameters(Autopilot* autopilot);

// The autopilot's own limits, as far as its parameters tell.
AutopilotLimits LimitsOf(const Autopilot& autopilot);

// The options of guidance for this autopilot, as far as its parameters tell.
GuidanceOptions OptionsFor(const Autopilot& autopilot, GuidanceOptions options);

// Its home position in the world, where it has told that.
std::optional<Eigen::Vector2d> HomeOf(const Autopilot& autopilot);

// One line on why guidance must not begin with this autopilot and the body at 'position' at 'now':
// not a multicopter, no estimate of its position, no home, limits beyond its own, out of the
// geofence around home. Empty when it may.
std::string WhyNotGuide(const Autopilot& autopilot, const FlightLimitsOptions& limits,
                        const Eigen::Vector3d& position, Time now);

// One line on a setting with which losing this program is dangerous; empty: none.
std::string DangerOfGuidance(const Autopilot& autopilot);

}  // namespace kestrel
