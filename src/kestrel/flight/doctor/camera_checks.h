// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"

namespace kestrel {

// Checks of the camera's output, independent of its calibration. Each returns one finding; a check
// without frames returns "not checked".
Finding CheckImages(const CameraObservations& camera);  // whether there are any
Finding CheckFrameRate(const CameraObservations& camera);
Finding CheckSteadiness(const CameraObservations& camera);  // jitter of the stamps
Finding CheckMissedFrames(const CameraObservations& camera);
Finding CheckFrozenFrames(const CameraObservations& camera);
Finding CheckCaptureClock(const CameraObservations& camera);
// Delay of a network's camera, whether it is known well enough for a target of this speed.
Finding CheckVideoDelay(const CameraObservations& camera, const DoctorUse& use);
Finding CheckExposure(const CameraObservations& camera);
Finding CheckFocus(const CameraObservations& camera);

// All of these checks.
std::vector<Finding> CheckCamera(const CameraObservations& camera, const DoctorUse& use = {});

}  // namespace kestrel
