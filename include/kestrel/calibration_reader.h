// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A reader for calibration files of Kalibr, EuRoC, ROS and OpenCV.
//
// Example:
//   const CameraCalibration calibration = ReadCalibration("camchain.yaml", "cam1");
//   const CameraModel camera(calibration.intrinsics);
//   if (!calibration.body_from_camera) std::cerr << "the file has no mount\n";

#include "kestrel/core/camera/calibration_reader.h"  // IWYU pragma: export
