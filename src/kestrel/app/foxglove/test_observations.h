// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "kestrel/app/views/landing_view.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/io/recording/frame.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

inline constexpr std::int64_t kFramePeriod_ns = 100'000'000;

inline CameraIntrinsics ObservedCamera() {
  return {64, 48, 40, 40, 31.5, 23.5, DistortionModel::kNone, {}};
}

inline CameraCalibration ObservedCalibration() {
  CameraCalibration calibration;
  calibration.intrinsics = ObservedCamera();
  return calibration;
}

inline LandingView ObservedView() {
  return ViewOf(ObservedCalibration(), LandingPipelineOptions());
}

inline Frame ObservedFrame(int index) {
  return {"frame", TimeFromNanoseconds(1'700'000'000'000'000'000 + index * kFramePeriod_ns),
          cv::Mat(48, 64, CV_8UC1, cv::Scalar(100))};
}

// The pattern is 2 m below the camera, which is 5 m above the world's origin. The track has it one
// metre to the east.
inline LandingObservation ObservedLanding(Time time) {
  LandingObservation observation;
  observation.time = time;
  TargetDetection found{};
  found.center_px = {31.5, 23.5};
  found.camera_from_target.translation = {0, 0, 2};
  found.covariance.setIdentity();
  found.covariance *= 0.01;
  found.method = DetectionMethod::kRing;
  found.quality = 0.9;
  observation.report.detection = found;
  observation.report.reached = LandingStage::kFound;
  observation.world_from_camera = RigidTransform{{0, 1, 0, 0}, {0, 0, 5}};
  observation.center_in_world = Eigen::Vector3d(0, 0, 3);
  observation.fate = MeasurementFate::kAccepted;
  observation.track_state = TrackState::kTracking;
  TargetEstimate target{time, {}};
  target.motion.mean.head<3>() << 1, 0, 3;
  target.motion.covariance.setIdentity();
  target.motion.covariance *= 0.04;
  observation.target = target;
  observation.detect_time = DurationFromSeconds(0.002);
  return observation;
}

}  // namespace kestrel
