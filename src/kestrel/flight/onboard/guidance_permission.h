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

// Requests the parameters that the functions below need.
void WantGuidanceParameters(Autopilot* autopilot);

// The autopilot's own limits, as far as its parameters are known.
AutopilotLimits LimitsOf(const Autopilot& autopilot);

// The options of guidance for this autopilot, as far as its parameters are known.
// 'is_in_its_frame': the world is the autopilot's local frame, in which it takes places.
GuidanceOptions OptionsFor(const Autopilot& autopilot, GuidanceOptions options,
                           bool is_in_its_frame);

// The autopilot's home position in the world, if it has reported one.
std::optional<Eigen::Vector3d> HomeOf(const Autopilot& autopilot);

// The height in the world of the ground under home, where a body stands whose origin is 'leg_m'
// above its feet; nothing while the autopilot has not reported a home position.
std::optional<double> GroundUnderHome(const Autopilot& autopilot, double leg_m);

// Returns one line that says why this autopilot is not flown by set-points at all: not a
// multicopter, or in a failsafe, with what the pilot has to do about that. PX4 stays in its
// failsafe, and refuses OFFBOARD, until another mode is given. Empty when it is flown.
std::string WhyNotFly(const Autopilot& autopilot, bool has_position);

// Returns one line that says why guidance must not begin with this autopilot and the body at
// 'position' at 'now': not a multicopter, no position estimate, no home, limits beyond its own, an
// unsafe reaction to the loss of set-points, out of the geofence around home. Empty when it may.
// 'is_position_by_pad': the autopilot's position ends with this program.
std::string WhyNotGuide(const Autopilot& autopilot, const GuidanceOptions& options,
                        const Eigen::Vector3d& position, Time now, bool is_position_by_pad);

// Returns one line on a reaction to the loss of set-points that does not hold the UAV, or, where
// its position is lost as well, not land it; empty: it does.
std::string UnsafeLoss(const Autopilot& autopilot, bool is_position_by_pad);

}  // namespace kestrel
