// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/guidance/landing_guidance.h"
#include "kestrel/simulation/autopilots/test_linked_flight.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

constexpr double kTestHalfView_deg = 20;
constexpr double kTestSightRange_m = 30;

// A camera that looks down, by 'tilt_deg' ahead, or one on a gimbal that looks along the platform's
// x axis.
inline CameraCalibration TestCamera(bool has_gimbal, double half_view_deg, double tilt_deg = 0) {
  CameraCalibration camera;
  const double f_px = 240 / std::tan(Radians(half_view_deg));
  camera.intrinsics = {640, 480, f_px, f_px, 319.5, 239.5, DistortionModel::kNone, {}};
  Eigen::Matrix3d axes;
  axes << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  camera.body_from_camera.emplace().rotation =
      RotationBy({0, -Radians(tilt_deg), 0}) * Eigen::Quaterniond(axes);
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
  // 'quarters_beyond_m': see TestEye.
  TrueDetector(const CameraModel& camera, const std::optional<RigidTransform>* seen,
               const double* quarters_beyond_m)
      : camera_(camera), seen_(*seen), quarters_beyond_m_(*quarters_beyond_m) {}

  TargetReport Detect(const cv::Mat& /*image*/, const TargetHint& /*hint*/,
                      TargetWorkspace& /*workspace*/) const override {
    constexpr double kError = 0.003, kTurn = 0.01;
    TargetReport report;
    if (!seen_) return report;
    TargetDetection detection{};
    detection.camera_from_target = *seen_;
    Eigen::Vector3d& center = detection.camera_from_target.translation;
    if (center.norm() > quarters_beyond_m_) {
      detection.camera_from_target.rotation *= RotationBy({0, 0, kFullTurn / 4});
      detection.heading_symmetry = 4;
    }
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
  const double& quarters_beyond_m_;
  mutable Random random_{1};
};

// View and faults of a camera.
struct TestEye {
  double sight_range_m = kTestSightRange_m;
  double half_view_deg = 0;  // 0: that of the flight
  // From where on the pad looks the same after each quarter turn.
  double quarters_beyond_m = std::numeric_limits<double>::infinity();
  double tilt_deg = 0;  // where it looks: 0 down, 90 ahead
  // Faults, while the UAV is lower above the pad than 'wrong_below_m'.
  double wrong_below_m = std::numeric_limits<double>::infinity();
  double late_s = 0;         // how late the stamps are
  double turned_deg = 0;     // how far a fixed mount is turned, about a horizontal axis of the body
  double turn_axis_deg = 0;  // where that axis lies, from the body's x axis to the left
  bool is_frozen = false;    // repeats its image
  bool is_stopped = false;   // sends no images
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
    std::vector<TestEye> cameras = std::vector<TestEye>(1);
    bool guides = false;
    bool sends_pad_position = false;
    std::optional<RelativeJob> without_position = {};
    FlightOptions flight = {};
    std::uint64_t seed = 1;
  };

  PointedFlight(AutopilotFirmware firmware, const AutopilotModelOptions& options,
                const VehicleWorldOptions& vehicle)
      : PointedFlight(firmware, options, vehicle, Choice()) {}
  PointedFlight(AutopilotFirmware firmware, const AutopilotModelOptions& options,
                const VehicleWorldOptions& vehicle, const Choice& choice)
      : LinkedFlight(firmware, options, vehicle, choice.seed,
                     TestCamera(choice.has_gimbal, choice.half_view_deg)),
        eyes_(EyesOf(choice)),
        pipeline_(Calibrations(), Detectors(), PipelineOptions()) {
    const PadInSight pad{1.2, kTestSightRange_m, TargetTrackerOptions()};
    if (choice.has_gimbal) Point(pad, pad.tracker);
    SetPointTask task{.without_position = choice.without_position,
                      .sends_pad_position = choice.sends_pad_position};
    if (choice.guides) {
      task.guidance = [](const GuidanceOptions& guidance) {
        return std::make_unique<LandingGuidance>(guidance);
      };
    }
    FlightOptions flight = choice.flight;
    flight.pad_origin = "47.397742,8.545594";
    FlyBySetPoints(flight, pad.tracker, task);
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
    return Degrees(AngleOff(WorldFromCamera(eyes_.front()).Inverse() * world.PatternAt(now)));
  }
  const CameraState& StateOf(std::size_t camera) const { return pipeline_.camera_state(camera); }
  // Time for which a camera has been left out because it contradicts the other, s.
  double LeftOutFor(std::size_t camera) const { return eyes_[camera].left_out_s; }
  // True if the camera has been left out, for whatever reason.
  bool HasBeenLeftOut(std::size_t camera) const { return eyes_[camera].has_been_left_out; }
  bool has_track() const { return track_.state == TrackState::kTracking; }

  // Changes what is wrong with a camera.
  void Change(std::size_t camera, const TestEye& eye) { eyes_[camera].own = eye; }

  bool is_blind = false;  // no image shows the pad any more
  // The pad is another one, so far away; m.
  Eigen::Vector3d pad_offset{0, 0, 0};

  void ResumePointing() { pointed_->Resume(); }

 private:
  // An image waits for the vision.
  struct Image {
    Time captured;
    std::optional<RigidTransform> camera_from_target;  // where the pad is in view
  };
  struct Eye {
    bool is_wrong(double height_m) const { return height_m < own.wrong_below_m; }

    TestEye own;
    CameraCalibration camera;
    double half_view;  // rad
    Time capture_due;
    std::deque<Image> images = {};
    std::optional<RigidTransform> seen = {};  // of the image that the vision has
    double left_out_s = 0;
    bool has_been_left_out = false;
    cv::Mat picture{8, 8, CV_8UC1};
  };

  // Their images come one after the other.
  static std::vector<Eye> EyesOf(const Choice& choice) {
    std::vector<Eye> eyes;
    for (const TestEye& each : choice.cameras) {
      const double view_deg = each.half_view_deg > 0 ? each.half_view_deg : choice.half_view_deg;
      eyes.push_back({each, TestCamera(choice.has_gimbal, view_deg, each.tilt_deg),
                      Radians(view_deg), kTestStart + eyes.size() * std::chrono::milliseconds(20)});
    }
    return eyes;
  }
  std::vector<CameraCalibration> Calibrations() const {
    std::vector<CameraCalibration> cameras;
    for (const Eye& eye : eyes_) cameras.push_back(eye.camera);
    return cameras;
  }
  std::vector<std::unique_ptr<const TargetDetector>> Detectors() const {
    std::vector<std::unique_ptr<const TargetDetector>> detectors;
    for (const Eye& eye : eyes_) {
      detectors.push_back(std::make_unique<TrueDetector>(CameraModel(eye.camera.intrinsics),
                                                         &eye.seen, &eye.own.quarters_beyond_m));
    }
    return detectors;
  }
  static LandingPipelineOptions PipelineOptions() {
    LandingPipelineOptions options;
    options.pose_extrapolation_s = 0.1;
    return options;
  }
  void TakePose(const PoseSample& pose) override { pipeline_.AddPose(pose); }
  void TakeGimbal(const GimbalSample& report) override { pipeline_.AddGimbal(report); }

  double Height() const {
    return model.truth().world_from_body.translation.z() - world.PatternAt(now).translation.z();
  }
  RigidTransform WorldFromCamera(const Eye& eye) const {
    if (eye.camera.gimbal) return LinkedFlight::WorldFromCamera();
    const double turned = eye.is_wrong(Height()) ? Radians(eye.own.turned_deg) : 0;
    const double axis = Radians(eye.own.turn_axis_deg);
    const RigidTransform turn{RotationBy({turned * std::cos(axis), turned * std::sin(axis), 0}),
                              {0, 0, 0}};
    return model.truth().world_from_body * turn * *eye.camera.body_from_camera;
  }
  static double AngleOff(const RigidTransform& camera_from_target) {
    const Eigen::Vector3d& center = camera_from_target.translation;
    return std::atan2(center.head<2>().norm(), center.z());
  }

  void See() override {
    for (std::size_t i = 0; i < eyes_.size(); ++i) {
      Capture(&eyes_[i]);
      Process(i);
      if (StateOf(i).health == CameraHealth::kContradicts) eyes_[i].left_out_s += kStep_s;
      if (!StateOf(i).is_used()) eyes_[i].has_been_left_out = true;
    }
  }
  void Capture(Eye* eye) {
    constexpr Duration kPeriod = std::chrono::milliseconds(60);
    constexpr double kNearest_m = 0.45;
    if (now < eye->capture_due) return;
    eye->capture_due = now + kPeriod;
    const bool is_wrong = eye->is_wrong(Height());
    if (is_wrong && eye->own.is_stopped) return;
    RigidTransform pad = world.PatternAt(now);
    pad.translation += pad_offset;
    const RigidTransform camera_from_target = WorldFromCamera(*eye).Inverse() * pad;
    const double distance_m = camera_from_target.translation.norm();
    const double late_s = is_wrong ? eye->own.late_s : 0;
    Image image{now + DurationFromSeconds(late_s), std::nullopt};
    if (AngleOff(camera_from_target) < eye->half_view && distance_m < eye->own.sight_range_m &&
        distance_m > kNearest_m) {
      image.camera_from_target = camera_from_target;
    }
    eye->images.push_back(image);
  }
  // The vision is done some time after the exposure.
  void Process(std::size_t camera) {
    constexpr Duration kLatency = std::chrono::milliseconds(40);
    Eye& eye = eyes_[camera];
    if (eye.images.empty() || now < eye.images.front().captured + kLatency) return;
    const Image image = eye.images.front();
    eye.images.pop_front();
    if (!eye.own.is_frozen || !eye.is_wrong(Height())) {
      eye.seen = image.camera_from_target;
      eye.picture.setTo(++pictures_ % 256);  // differs from the one before
    }
    if (is_blind) eye.seen.reset();
    const LandingObservation seen = pipeline_.Process(eye.picture, image.captured, camera);
    if (!StateOf(camera).is_used()) return;
    track_.captured = image.captured;
    track_.state = seen.track_state;
    track_.target = seen.target;
    track_.sighting.reset();
    if (const auto& detection = seen.report.detection; detection && seen.camera_from_body) {
      track_.sight = SightOf(*detection, *seen.camera_from_body, image.captured);
    }
    if (!seen.center_in_world) return;
    if (seen.fate == MeasurementFate::kStarted || seen.fate == MeasurementFate::kAccepted) {
      track_.seen = image.captured;
    }
    TargetState& sighting = track_.sighting.emplace();
    sighting.time = image.captured;
    sighting.position_in_world = *seen.center_in_world;
    sighting.normal_in_world = Eigen::Vector3d::UnitZ();
  }

  std::vector<Eye> eyes_;  // their places do not change
  LandingPipeline pipeline_;
  int pictures_ = 0;
};

}  // namespace kestrel
