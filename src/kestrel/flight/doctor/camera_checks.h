// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"

namespace kestrel {

// Checks of what comes out of the camera, whatever its calibration says. Each gives one finding;
// those without frames say that they were not checked.
Finding CheckImages(const CameraObservations& camera);  // whether there are any
Finding CheckFrameRate(const CameraObservations& camera);
Finding CheckSteadiness(const CameraObservations& camera);  // jitter of the stamps
Finding CheckMissedFrames(const CameraObservations& camera);
Finding CheckFrozenFrames(const CameraObservations& camera);
Finding CheckCaptureClock(const CameraObservations& camera);
Finding CheckExposure(const CameraObservations& camera);
Finding CheckFocus(const CameraObservations& camera);

// All of them.
std::vector<Finding> CheckCamera(const CameraObservations& camera);

}  // namespace kestrel
