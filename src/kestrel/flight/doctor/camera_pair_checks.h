// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"

namespace kestrel {

// Compares where, and when, two cameras with fixed mounts show the pattern in the body.
Finding CheckCamerasTogether(const CameraSetup& first, const CameraSetup& further);

}  // namespace kestrel
