// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"

namespace kestrel {

// Checks of the calibration: against the images, in itself, and against the pattern in view.
Finding CheckImageSize(const CameraIntrinsics& intrinsics, const CameraObservations& camera);
Finding CheckLensModel(const CameraIntrinsics& intrinsics);  // valid to the rim of the image
Finding CheckPixelShape(const CameraIntrinsics& intrinsics);
Finding CheckCalibrationByPattern(const VisionObservations& vision);

std::vector<Finding> CheckCalibration(const DoctorObservations& observations);

}  // namespace kestrel
