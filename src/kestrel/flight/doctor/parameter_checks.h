// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "kestrel/flight/doctor/check_list.h"
#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"

namespace kestrel {

// The parameters that the checks use, by their first names; none for other autopilots.
std::span<const ListedCheck> CheckedParameters(AutopilotKind kind);

// Checks that the autopilot understands the messages of the profile.
Finding CheckProfile(const DoctorObservations& observations);

// Checks the time from a frame's exposure to the use of its result against the delay that the
// autopilot assumes.
Finding CheckLatency(const DoctorObservations& observations);

// Checks the autopilot's parameters for the intended use. Returns one finding for each parameter
// that matters for it.
std::vector<Finding> CheckParameters(const DoctorObservations& observations);

}  // namespace kestrel
