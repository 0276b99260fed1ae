// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"

namespace kestrel {

// Checks of the line to the autopilot and of its messages, except its parameters.
Finding CheckLine(const LinkObservations& link);
Finding CheckSigning(const LinkObservations& link);
Finding CheckHeartbeat(const LinkObservations& link);
Finding CheckVersion(const LinkObservations& link);
Finding CheckVehicle(const LinkObservations& link);
Finding CheckAttitudes(const LinkObservations& link, const DoctorUse& use);
Finding CheckPositions(const LinkObservations& link, const DoctorUse& use);
Finding CheckEstimate(const LinkObservations& link);  // by the autopilot's own estimator
Finding CheckAutopilotClock(const LinkObservations& link);
Finding CheckRoundTrip(const LinkObservations& link, const DoctorUse& use);
Finding CheckLinkEvents(const LinkObservations& link);

// All of these checks; without a heartbeat only the first three.
std::vector<Finding> CheckLink(const LinkObservations& link, const DoctorUse& use);

// Returns the profile used to report the target: the chosen one, or one by the heartbeat.
LinkProfile ProfileOf(const DoctorObservations& observations);

}  // namespace kestrel
