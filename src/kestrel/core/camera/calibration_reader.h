// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kestrel/core/camera/calibration.h"

namespace kestrel {

// Reads a camera's calibration. The content determines the format, not the file's name:
//
//   Kalibr camchain.yaml   maps cam0, cam1, ...: 'camera' names one, empty takes the first
//   EuRoC sensor.yaml      intrinsics: [fu, fv, cu, cv], resolution, distortion_coefficients, T_BS
//   ROS camera_info YAML   camera_matrix (or K) with distortion_model; a file or an echoed message
//   OpenCV FileStorage     camera_matrix (or Camera_Matrix, cameraMatrix, K), image_width, ...
//
// OpenCV files seldom name the lens: 'fisheye_model' (0 or 1) or 'distortion_model' does. Without
// either, 5 or 8 coefficients are radial-tangential, and 4 are refused because they are ambiguous.
// The mount comes from T_BS (body_from_camera) or T_cam_imu (its inverse), the clock offset from
// timeshift_cam_imu (s, t_imu = t_cam + shift), in any of the formats.
//
// Throws InputError with file, line, key and what was expected: file missing, not YAML or
// truncated, key missing or of the wrong type, NaN, wrong number of coefficients, unsupported lens
// (omni, eucm, ds, fov), T_BS that is not rigid, and all violations of CameraIntrinsics::Validate.
CameraCalibration ReadCalibration(const std::filesystem::path& file,
                                  const std::string& camera = "");

// The same from text. 'file' is the name in messages.
CameraCalibration ParseCalibration(std::string_view text, const std::string& file,
                                   const std::string& camera = "");

}  // namespace kestrel
