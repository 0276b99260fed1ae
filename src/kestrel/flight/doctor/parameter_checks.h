// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"

namespace kestrel {

// First names of the parameters that the checks use; none for other autopilots.
std::span<const std::string_view> CheckedParameters(AutopilotKind kind);

// Checks that the autopilot understands the messages of the profile.
Finding CheckProfile(const DoctorObservations& observations);

// Checks the time from a frame's exposure to the use of its result against the delay that the
// autopilot assumes.
Finding CheckLatency(const DoctorObservations& observations);

// Checks the autopilot's parameters for the intended use. Returns one finding for each parameter
// that matters for it.
std::vector<Finding> CheckParameters(const DoctorObservations& observations);

}  // namespace kestrel
