// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/pose_history.h"

namespace kestrel {

struct CameraPose {
  RigidTransform world_from_camera;
  PoseUncertainty uncertainty;  // in addition to that of a reported pose
};

// Poses of the camera at the times of its images, from the navigation's poses, the mount and the
// clock offset.
class CameraPoses {
 public:
  // 'smoothing': see PoseHistory::Smooth; zero leaves the poses as they are. 'max_ahead': longest
  // prediction of a pose beyond the newest one.
  CameraPoses(const CameraCalibration& calibration, std::size_t capacity, Duration max_gap,
              Duration smoothing, Duration max_ahead)
      : body_from_camera_(calibration.body_from_camera),
        clock_offset_(calibration.clock_offset.value_or(Duration::zero())),
        smoothing_(smoothing),
        max_ahead_(max_ahead),
        poses_(capacity, max_gap) {}

  // Adds a pose from the navigation, on its clock.
  PoseStatus Add(const PoseSample& sample) { return poses_.Add(sample); }

  // Returns whether there is a pose for a time on the images' clock, or why not.
  PoseLookup Check(Time image_time) const {
    const PoseLookup lookup = poses_.Check(image_time + clock_offset_);
    const bool is_predicted = lookup == PoseLookup::kTooNew && Predict(image_time);
    return is_predicted ? PoseLookup::kPredicted : lookup;
  }

  // Returns the camera's pose at a time on the images' clock; nothing without a mount or a pose.
  std::optional<CameraPose> At(Time image_time) const {
    if (!body_from_camera_) return std::nullopt;
    if (const auto world_from_body = poses_.Smooth(image_time + clock_offset_, smoothing_)) {
      return CameraPose{*world_from_body * *body_from_camera_, {}};
    }
    const auto predicted = Predict(image_time);
    if (!predicted) return std::nullopt;
    return CameraPose{predicted->world_from_body * *body_from_camera_, predicted->uncertainty};
  }

 private:
  std::optional<PredictedPose> Predict(Time image_time) const {
    return poses_.Predict(image_time + clock_offset_, max_ahead_, UnmodelledMotion());
  }

  std::optional<RigidTransform> body_from_camera_;
  Duration clock_offset_;
  Duration smoothing_;
  Duration max_ahead_;
  PoseHistory poses_;
};

}  // namespace kestrel
