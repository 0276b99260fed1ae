// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cmath>
#include <cstddef>
#include <optional>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"

namespace kestrel {

struct CameraPose {
  RigidTransform world_from_camera;
  RigidTransform camera_from_body;  // at this time: a gimbal turns
  PoseUncertainty uncertainty;      // in addition to that of a reported pose
};

// Poses of the camera at the times of its images, from the navigation's poses, the mount (with the
// reports of its gimbal, if it has one) and the clock offset.
class CameraPoses {
 public:
  // 'smoothing': see PoseHistory::Smooth; zero leaves the poses as they are. 'max_ahead': longest
  // prediction of a pose beyond the newest one.
  CameraPoses(const CameraCalibration& calibration, std::size_t capacity, Duration max_gap,
              Duration smoothing, Duration max_ahead)
      : body_from_camera_(calibration.body_from_camera),
        gimbal_(calibration.gimbal),
        clock_offset_(calibration.clock_offset.value_or(Duration::zero())),
        smoothing_(smoothing),
        max_ahead_(max_ahead),
        poses_(capacity, max_gap),
        gimbal_history_(gimbal_ ? capacity : 0) {}

  // Adds a pose from the navigation, on its clock.
  PoseStatus Add(const PoseSample& sample) { return poses_.Add(sample); }

  // Adds a report of the gimbal, on its clock.
  PoseStatus Add(const GimbalSample& sample) { return gimbal_history_.Add(sample); }

  // Turns the camera on its gimbal's platform, about the camera's own axes.
  void TurnOnGimbal(const Eigen::Quaterniond& turn) {
    Eigen::Quaterniond& rotation = gimbal_->platform_from_camera.rotation;
    rotation = (rotation * turn).normalized();
  }

  // Returns whether there is a pose for a time on the images' clock, or why not.
  PoseLookup Check(Time image_time) const {
    const PoseLookup lookup = poses_.Check(image_time + clock_offset_);
    const bool is_predicted = lookup == PoseLookup::kTooNew && Predict(image_time);
    const PoseLookup found = is_predicted ? PoseLookup::kPredicted : lookup;
    const bool has_pose = found == PoseLookup::kFound || found == PoseLookup::kPredicted;
    return gimbal_ && has_pose && !GimbalAt(image_time) ? PoseLookup::kNoGimbal : found;
  }

  // Returns the camera's pose at a time on the images' clock; nothing without a mount, a pose, or
  // the attitude of the gimbal that the mount has.
  std::optional<CameraPose> At(Time image_time) const {
    if (const auto world_from_body = poses_.Smooth(image_time + clock_offset_, smoothing_)) {
      return OnMount({*world_from_body, {}}, image_time);
    }
    const auto predicted = Predict(image_time);
    if (!predicted) return std::nullopt;
    return OnMount({predicted->world_from_body, predicted->uncertainty}, image_time);
  }

 private:
  // Slow gimbals report five times a second.
  static constexpr Duration kMaxGimbalAhead = std::chrono::milliseconds(300);

  struct BodyPose {
    RigidTransform world_from_body;
    PoseUncertainty uncertainty;
  };

  std::optional<CameraPose> OnMount(const BodyPose& body, Time image_time) const {
    if (!body_from_camera_) return std::nullopt;
    if (gimbal_) return OnGimbal(body, image_time);
    return CameraPose{body.world_from_body * *body_from_camera_, body_from_camera_->Inverse(),
                      body.uncertainty};
  }

  std::optional<GimbalAttitude> GimbalAt(Time image_time) const {
    return gimbal_history_.At(image_time + clock_offset_ - gimbal_->clock_offset, kMaxGimbalAhead);
  }

  std::optional<CameraPose> OnGimbal(const BodyPose& body, Time image_time) const {
    const auto attitude = GimbalAt(image_time);
    if (!attitude) return std::nullopt;
    PoseUncertainty uncertainty = body.uncertainty;
    uncertainty.attitude_rad = std::hypot(uncertainty.attitude_rad, attitude->sigma_rad);
    const RigidTransform world_from_camera =
        WorldFromPlatform(body.world_from_body, gimbal_->body_from_pivot, *attitude) *
        gimbal_->platform_from_camera;
    return CameraPose{world_from_camera, world_from_camera.Inverse() * body.world_from_body,
                      uncertainty};
  }

  std::optional<PredictedPose> Predict(Time image_time) const {
    return poses_.Predict(image_time + clock_offset_, max_ahead_, UnmodelledMotion());
  }

  std::optional<RigidTransform> body_from_camera_;
  std::optional<GimbalMount> gimbal_;
  Duration clock_offset_;
  Duration smoothing_;
  Duration max_ahead_;
  PoseHistory poses_;
  GimbalHistory gimbal_history_;
};

}  // namespace kestrel
