// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/camera/calibration.h"
#include "kestrel/io/ros_messages/messages.h"

namespace kestrel {

// Returns the lens and image size of a message. The lens models are plumb_bob, rational_polynomial,
// equidistant and fisheye; without coefficients there is no distortion. 'is_rectified': the images
// are undistorted by image_proc, so that P describes them. Throws InputError with 'name' when the
// camera is not calibrated, for everything that ReadCalibration refuses, and for binning and
// regions of interest.
CameraCalibration CalibrationOf(const CameraInfoMessage& message, bool is_rectified,
                                const std::string& name);

// Returns the message of a camera, without a header. The message has no place for a mount.
CameraInfoMessage CameraInfoOf(const CameraIntrinsics& camera);

}  // namespace kestrel
