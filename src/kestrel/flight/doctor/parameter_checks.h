// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"

namespace kestrel {

// First names of the parameters that the checks look at; none for other autopilots.
std::span<const std::string_view> CheckedParameters(AutopilotKind kind);

// Whether the autopilot understands the messages of the profile.
Finding CheckProfile(const DoctorObservations& observations);

// From the light of a frame to the use of what it showed, against what the autopilot reckons with.
Finding CheckLatency(const DoctorObservations& observations);

// The autopilot's parameters, for what the set-up is to be used for. One finding for each that
// matters then.
std::vector<Finding> CheckParameters(const DoctorObservations& observations);

}  // namespace kestrel
