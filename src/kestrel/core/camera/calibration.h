// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// The content of a camera's calibration file. Missing entries are empty, never defaults.
struct CameraCalibration {
  CameraIntrinsics intrinsics;
  std::optional<RigidTransform> body_from_camera;  // the mount
  std::optional<Duration> clock_offset;            // t_nav = t_image + clock_offset
  std::string name;                                // as in the file; empty when it has none
};

}  // namespace kestrel
