// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/camera/zoom_lens.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// A mount that moves: the camera is fixed to the platform of a gimbal.
struct GimbalMount {
  RigidTransform body_from_pivot;       // the platform when it is level and looks ahead
  RigidTransform platform_from_camera;  // the platform: x forward, y left, z up
  Duration clock_offset{};              // t_nav = t_gimbal + clock_offset
  int device_id = 0;                    // MAVLink's gimbal_device_id; 0: the first one heard
};

// The content of a camera's calibration file. Missing entries are empty, never defaults.
struct CameraCalibration {
  CameraIntrinsics intrinsics;
  std::optional<RigidTransform> body_from_camera;  // the mount; of a gimbal's: level, looking ahead
  std::optional<GimbalMount> gimbal;               // where the mount moves
  std::optional<ZoomLens> zoom;                    // where the lens changes
  std::optional<Duration> clock_offset;            // t_nav = t_image + clock_offset
  std::string name;                                // as in the file; empty when it has none
};

// Throws InputError where the lens changes, which 'task' ("a hunt") does not follow.
void RequireFixedLens(const CameraCalibration& camera, const std::string& task);

}  // namespace kestrel
