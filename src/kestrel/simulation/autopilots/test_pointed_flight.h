// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/guidance/landing_guidance.h"
#include "kestrel/simulation/autopilots/test_linked_flight.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

constexpr double kTestHalfView_deg = 20;
constexpr double kTestSightRange_m = 30;

// A camera that looks down, or one on a gimbal that looks along the platform's x axis.
inline CameraCalibration TestCamera(bool has_gimbal, double half_view_deg) {
  CameraCalibration camera;
  const double f_px = 240 / std::tan(Radians(half_view_deg));
  camera.intrinsics = {640, 480, f_px, f_px, 319.5, 239.5, DistortionModel::kNone, {}};
  Eigen::Matrix3d axes;
  axes << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  camera.body_from_camera.emplace().rotation = Eigen::Quaterniond(axes);
  if (!has_gimbal) return camera;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  camera.gimbal.emplace().platform_from_camera.rotation = Eigen::Quaterniond(axes);
  camera.body_from_camera = camera.gimbal->platform_from_camera;
  return camera;
}

// Finds the pad where it truly is, with an error of 0.3 % of the distance.
class TrueDetector : public TargetDetector {
 public:
  // 'seen': the true camera_from_target of the image; nothing: it is out of view.
  TrueDetector(const CameraModel& camera, const std::optional<RigidTransform>* seen)
      : camera_(camera), seen_(*seen) {}

  TargetReport Detect(const cv::Mat& /*image*/, const TargetHint& /*hint*/,
                      TargetWorkspace& /*workspace*/) const override {
    constexpr double kError = 0.003, kTurn = 0.01;
    TargetReport report;
    if (!seen_) return report;
    TargetDetection detection{};
    detection.camera_from_target = *seen_;
    Eigen::Vector3d& center = detection.camera_from_target.translation;
    const double sigma_m = kError * center.norm();
    for (double& axis : center) axis += sigma_m * random_.Normal();
    detection.covariance.setZero();
    detection.covariance.diagonal().head<3>().setConstant(sigma_m * sigma_m);
    detection.covariance.diagonal().tail<3>().setConstant(kTurn * kTurn);
    report.detection = detection;
    return report;
  }
  std::unique_ptr<TargetWorkspace> MakeWorkspace() const override {
    return std::make_unique<TargetWorkspace>();
  }
  const CameraModel& camera() const override { return camera_; }
  const TargetShape& shape() const override { return shape_; }

 private:
  CameraModel camera_;
  TargetShape shape_;
  const std::optional<RigidTransform>& seen_;
  mutable Random random_{1};
};

// Statistics of the angle between the camera's axis and the target, deg.
struct PointingErrors {
  double rms = 0;
  double largest = 0;
};

// A linked flight with the landing pipeline, which gets the truth instead of images.
class PointedFlight : public LinkedFlight {
 public:
  struct Choice {
    bool has_gimbal = true;  // the camera is on one
    double half_view_deg = kTestHalfView_deg;
    bool guides = false;
    std::uint64_t seed = 1;
  };

  PointedFlight(AutopilotFirmware firmware, const AutopilotModelOptions& options,
                const VehicleWorldOptions& vehicle)
      : PointedFlight(firmware, options, vehicle, Choice()) {}
  PointedFlight(AutopilotFirmware firmware, const AutopilotModelOptions& options,
                const VehicleWorldOptions& vehicle, const Choice& choice)
      : LinkedFlight(firmware, options, vehicle, choice.seed,
                     TestCamera(choice.has_gimbal, choice.half_view_deg)),
        half_view_(Radians(choice.half_view_deg)),
        pipeline_(camera_, std::make_unique<TrueDetector>(CameraModel(camera_.intrinsics), &seen_),
                  PipelineOptions()) {
    const PadInSight pad{1.2, kTestSightRange_m, TargetTrackerOptions()};
    if (choice.has_gimbal) Point(pad, pad.tracker);
    if (!choice.guides) return;
    Guide(FlightOptions(), pad.tracker, [](const GuidanceOptions& guidance) {
      return std::make_unique<LandingGuidance>(guidance);
    });
  }

  PointingErrors FlyAndMeasure(double seconds) {
    PointingErrors errors;
    int steps = 0;
    Run(seconds, [&] {
      Step();
      const double error = Error();
      errors.rms += error * error;
      errors.largest = std::max(errors.largest, error);
      ++steps;
    });
    errors.rms = std::sqrt(errors.rms / steps);
    return errors;
  }
  // Flies until there is a track; false when that takes longer.
  bool FlyUntilFound(double longest_s) {
    for (double s = 0; s < longest_s && !has_track(); ++s) Fly(1);
    return has_track();
  }
  // Flies until it has disarmed; false when that takes longer.
  bool Land(double longest_s) {
    Run(longest_s, [this] {
      if (model.is_armed()) Step();
    });
    return !model.is_armed();
  }

  // Angle between the camera's axis and the target, deg.
  double Error() const {
    return Degrees(AngleOff(WorldFromCamera().Inverse() * world.PatternAt(now)));
  }
  bool has_track() const { return track_.state == TrackState::kTracking; }

 private:
  // An image waits for the vision.
  struct Image {
    Time captured;
    std::optional<RigidTransform> camera_from_target;  // where the pad is in view
  };

  static LandingPipelineOptions PipelineOptions() {
    LandingPipelineOptions options;
    options.pose_extrapolation_s = 0.1;
    return options;
  }
  void TakePose(const PoseSample& pose) override { pipeline_.AddPose(pose); }
  void TakeGimbal(const GimbalSample& report) override { pipeline_.AddGimbal(report); }

  static double AngleOff(const RigidTransform& camera_from_target) {
    const Eigen::Vector3d& center = camera_from_target.translation;
    return std::atan2(center.head<2>().norm(), center.z());
  }

  void See() override {
    Capture();
    Process();
  }
  void Capture() {
    constexpr Duration kPeriod = std::chrono::milliseconds(60);
    constexpr double kNearest_m = 0.45;
    if (now < capture_due_) return;
    capture_due_ = now + kPeriod;
    const RigidTransform camera_from_target = WorldFromCamera().Inverse() * world.PatternAt(now);
    const double distance_m = camera_from_target.translation.norm();
    Image image{now, std::nullopt};
    if (AngleOff(camera_from_target) < half_view_ && distance_m < kTestSightRange_m &&
        distance_m > kNearest_m) {
      image.camera_from_target = camera_from_target;
    }
    images_.push_back(image);
  }
  // The vision is done some time after the exposure.
  void Process() {
    constexpr Duration kLatency = std::chrono::milliseconds(40);
    if (images_.empty() || now < images_.front().captured + kLatency) return;
    const Image image = images_.front();
    images_.pop_front();
    seen_ = image.camera_from_target;
    const LandingObservation seen = pipeline_.Process(cv::Mat(), image.captured);
    track_.captured = image.captured;
    track_.state = seen.track_state;
    track_.target = seen.target;
    track_.sighting.reset();
    if (!seen.center_in_world) return;
    if (seen.fate == MeasurementFate::kStarted || seen.fate == MeasurementFate::kAccepted) {
      track_.seen = image.captured;
    }
    TargetState& sighting = track_.sighting.emplace();
    sighting.time = image.captured;
    sighting.position_in_world = *seen.center_in_world;
    sighting.normal_in_world = Eigen::Vector3d::UnitZ();
  }

  double half_view_;
  std::optional<RigidTransform> seen_;
  LandingPipeline pipeline_;
  std::deque<Image> images_;
  Time capture_due_{};
};

}  // namespace kestrel
