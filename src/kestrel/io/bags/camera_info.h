// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/camera/calibration.h"
#include "kestrel/io/bags/messages.h"

namespace kestrel {

// The lens and size that a message tells: lens by the names plumb_bob, rational_polynomial,
// equidistant and fisheye; no coefficients are no distortion. 'is_rectified': of the images that
// image_proc has undistorted, which P describes. Throws InputError, with 'name', when the camera is
// not calibrated, and for all that ReadCalibration refuses; for binning and regions of interest.
CameraCalibration CalibrationOf(const CameraInfoMessage& message, bool is_rectified,
                                const std::string& name);

// The other way, without header. A mount has no place in the message.
CameraInfoMessage CameraInfoOf(const CameraIntrinsics& camera);

}  // namespace kestrel
