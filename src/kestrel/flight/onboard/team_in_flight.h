// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/comms/team/team_goal.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/guidance/other_uav.h"
#include "kestrel/flight/onboard/guided_flight.h"

namespace kestrel {

// Returns what guidance needs of a goal.
TeamInFlight InFlight(const TeamGoal& goal);

// Returns what the team needs of a flight at 'now'. 'before': the same, the last time: without a
// pose the UAV stays there for the others until it is on the ground.
FlightToObjects ToObjects(const GuidedFlight& guided, const PoseHistory& poses, Time now,
                          const FlightToObjects& before);

}  // namespace kestrel
