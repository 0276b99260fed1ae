// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"

namespace kestrel {

// Checks of the gimbal that the camera is on.

// Checks that reports come often enough.
Finding CheckGimbalReports(const LinkObservations& link);

// Checks that the reported attitude is that of motors: it does not jump, and stays level while the
// UAV tilts.
Finding CheckGimbalMotors(const GimbalObservations& gimbal);

// Checks that the pattern stays where it is by the reports of the gimbal: in the frame of the yaw
// that they claim, and at their time.
Finding CheckGimbalByImages(const DoctorObservations& observations);

// Checks that nobody else controls the gimbal, where it is to be pointed.
Finding CheckGimbalControl(const DoctorObservations& observations);

// Checks that the camera can look straight down.
Finding CheckGimbalRange(const DoctorObservations& observations);

// All of these checks.
std::vector<Finding> CheckGimbal(const DoctorObservations& observations);

}  // namespace kestrel
