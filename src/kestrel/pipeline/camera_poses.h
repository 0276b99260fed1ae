// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>

#include "kestrel/base/time.h"
#include "kestrel/camera/calibration.h"
#include "kestrel/geometry/rigid_transform.h"
#include "kestrel/navigation/pose_history.h"

namespace kestrel {

// Where the camera was when its light was collected: the navigation's poses, the mount and the
// clock offset.
class CameraPoses {
 public:
  // 'smoothing': see PoseHistory::Smooth; none: poses as they are.
  CameraPoses(const CameraCalibration& calibration, std::size_t capacity, Duration max_gap,
              Duration smoothing = Duration::zero())
      : body_from_camera_(calibration.body_from_camera),
        clock_offset_(calibration.clock_offset.value_or(Duration::zero())),
        smoothing_(smoothing),
        poses_(capacity, max_gap) {}

  // A pose from the navigation, on its clock.
  PoseStatus Add(const PoseSample& sample) { return poses_.Add(sample); }

  // Whether the navigation has a pose for an instant of the images' clock, or why not.
  PoseLookup Check(Time image_time) const { return poses_.Check(image_time + clock_offset_); }

  // 'world_from_camera' at an instant of the images' clock; nothing without a mount or a pose.
  std::optional<RigidTransform> At(Time image_time) const {
    if (!body_from_camera_) return std::nullopt;
    const auto world_from_body = poses_.Smooth(image_time + clock_offset_, smoothing_);
    if (!world_from_body) return std::nullopt;
    return *world_from_body * *body_from_camera_;
  }

 private:
  std::optional<RigidTransform> body_from_camera_;
  Duration clock_offset_;
  Duration smoothing_;
  PoseHistory poses_;
};

}  // namespace kestrel
