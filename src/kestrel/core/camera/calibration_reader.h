// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "kestrel/core/camera/calibration.h"

namespace kestrel {

// Reads a camera's calibration. The content determines the format, not the file's name:
//
//   Kalibr camchain.yaml   maps cam0, cam1, ...: 'camera' names one, empty takes the first
//   EuRoC sensor.yaml      intrinsics: [fu, fv, cu, cv], resolution, distortion_coefficients, T_BS
//   ROS camera_info YAML   camera_matrix (or K) with distortion_model; a file or an echoed message
//   OpenCV FileStorage     camera_matrix (or K, mtx), image_width, ...; YAML, XML, or JSON
//   camodocal, VINS        model_type PINHOLE, PINHOLE_FULL or KANNALA_BRANDT
//   ORB-SLAM               Camera.type PinHole or KannalaBrandt8
//
// A key counts in any spelling: Camera_Matrix, cameraMatrix. OpenCV files seldom name the lens:
// 'fisheye_model' (0 or 1) or 'distortion_model' does. Without either, 5 or 8 coefficients are
// radial-tangential, and 4 are refused because they are ambiguous. In any of the formats, the mount
// comes from T_BS, T_imu_cam, T_BC, body_T_cam0 (body_from_camera), T_cam_imu, T_CB (its inverse)
// or extrinsicRotation with extrinsicTranslation, and the clock offset from timeshift_cam_imu, td
// or time_offset_s (s, t_imu = t_cam + shift). A camera on a gimbal has T_GS (platform_from_camera)
// and 'gimbal': a map with T_BG (body_from_pivot), time_offset_s and device_id, or the name of the
// folder whose sensor.yaml has these. A camera that zooms has 'zoom', in the same two forms, with
// settings (rows of hfov_deg, fu, fv, cu, cv and the coefficients), time_offset_s and device_id.
// 'notify' is called with the keys that are not known, a line
// for the user.
//
// Throws InputError with file, line, key and what was expected: file missing, not YAML or
// truncated, key missing or of the wrong type, two keys that contradict each other, NaN, wrong
// number of coefficients, unsupported lens (omni, eucm, ds, fov, MEI), a mount that is not rigid,
// binning or a region of interest, and all violations of CameraIntrinsics::Validate.
CameraCalibration ReadCalibration(const std::filesystem::path& file, const std::string& camera = "",
                                  const std::function<void(const std::string&)>& notify = {});

// The same from text. 'file' is the name in messages.
CameraCalibration ParseCalibration(std::string_view text, const std::string& file,
                                   const std::string& camera = "",
                                   const std::function<void(const std::string&)>& notify = {});

}  // namespace kestrel
