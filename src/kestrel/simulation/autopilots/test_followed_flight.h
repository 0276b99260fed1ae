// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include <Eigen/Geometry>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/guidance/follow_guidance.h"
#include "kestrel/flight/guidance/go_guidance.h"
#include "kestrel/simulation/autopilots/test_late_images.h"
#include "kestrel/simulation/autopilots/test_linked_flight.h"
#include "kestrel/vision/pipeline/follow_pipeline.h"
#include "kestrel/vision/pipeline/world_location.h"

namespace kestrel {

// A camera of 75 by 60 degrees that is fixed to the body and looks ahead and down by 'down_deg';
// nothing: one on a gimbal.
inline CameraCalibration FollowCamera(const std::optional<double>& down_deg) {
  CameraCalibration camera;
  camera.intrinsics = {640, 480, 416, 416, 319.5, 239.5, DistortionModel::kNone, {}};
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Quaterniond ahead(axes);
  if (!down_deg) camera.gimbal.emplace().platform_from_camera.rotation = ahead;
  const Eigen::AngleAxisd down(Radians(down_deg.value_or(0)), Eigen::Vector3d::UnitY());
  camera.body_from_camera.emplace().rotation = down * ahead;
  return camera;
}

// A linked flight that follows the vehicle, which a person marks as soon as it is in view; a gimbal
// looks down to it until then. In place of images it gets the vehicle's true place on the ground,
// with the errors of a region's place: those of one image, and those that stay. With a job it flies
// down on the vehicle.
class FollowedFlight : public LinkedFlight {
 public:
  FollowedFlight(AutopilotFirmware firmware, const AutopilotModelOptions& options,
                 const VehicleWorldOptions& vehicle, const FlightOptions& flight,
                 const std::optional<double>& down_deg, std::uint64_t seed,
                 const std::optional<GoJob>& job = {})
      : LinkedFlight(firmware, options, vehicle, seed, FollowCamera(down_deg)),
        lens_(camera_.intrinsics),
        follow_(flight.guidance.follow),
        random_(seed) {
    std::optional<ViewLimits> view;
    if (down_deg) view.emplace(camera_.intrinsics, *camera_.body_from_camera);
    const TargetTrackerOptions tracker = FollowPipelineOptions().Tracker();
    FlyBySetPoints(
        flight, tracker,
        {.guidance = [view, job](const GuidanceOptions& guidance) -> std::unique_ptr<Guidance> {
          if (job) return std::make_unique<GoGuidance>(guidance, *job);
          return std::make_unique<FollowGuidance>(guidance, view);
        }});
    if (!down_deg) Point(std::nullopt, tracker);
    for (double& error : stays_) error = random_.Normal();
    if (!down_deg) GiveControl(255, 190);
  }

  GuidancePhase phase() const { return flown_->phase(); }
  void Confirm() { flown_->by_position()->Take({++orders_, 1}); }
  void Stop() { flown_->by_position()->Take({++orders_, 0}); }
  // Confirms as soon as guidance has the UAV; false when it has not followed after that time.
  bool FollowWithin(double longest_s) {
    for (double s = 0; s < longest_s; s += kLook_s) {
      Fly(kLook_s);
      if (phase() == GuidancePhase::kLook) Confirm();
      if (phase() == GuidancePhase::kFollow) return true;
    }
    return false;
  }

  struct Result {
    double share = 0;       // share of the time in which the distance is within a tenth
    double seen_share = 0;  // share of the images that show the vehicle
    double worst_m = 0;     // error of the distance
    double lowest_m = 1e9;  // height above the ground
  };
  Result FlyAndMeasure(double seconds) {
    Result result;
    int steps = 0, good = 0;
    images_taken_ = images_with_it_ = 0;
    Run(seconds, [&] {
      Step();
      const Eigen::Vector3d uav = model.truth().world_from_body.translation;
      const double off_m = std::abs((Place() - uav).head<2>().norm() - follow_.distance_m);
      ++steps;
      good += off_m < 0.1 * follow_.distance_m ? 1 : 0;
      result.worst_m = std::max(result.worst_m, off_m);
      result.lowest_m = std::min(result.lowest_m, uav.z());
    });
    result.share = static_cast<double>(good) / steps;
    result.seen_share = static_cast<double>(images_with_it_) / std::max(images_taken_, 1);
    return result;
  }

 private:
  static constexpr double kLook_s = 0.5;
  struct Image {
    Time captured;
    std::optional<Eigen::Vector3d> sight;  // from the camera to the vehicle, where it is in view
  };

  // Where the vehicle truly stands on the ground.
  Eigen::Vector3d Place() const {
    const Eigen::Vector3d pattern = world.PatternAt(now).translation;
    return {pattern.x(), pattern.y(), 0};
  }

  void See() override {
    if (camera_.gimbal && track_.mark == 0) LookDown();
    images_.See(
        now, [this] { return Capture(); }, [this](const Image& image) { Process(image); });
  }

  // A person does that at the ground station.
  void LookDown() {
    mavlink::GimbalManagerSetPitchyaw slider;
    slider.pitch = static_cast<float>(Radians(-45.0));
    slider.yaw = 0;
    slider.pitch_rate = slider.yaw_rate = std::numeric_limits<float>::quiet_NaN();
    SendFromGround(slider);
  }

  Image Capture() {
    const RigidTransform world_from_camera = WorldFromCamera();
    Eigen::Vector2d pixel;
    const bool is_in_view =
        lens_.Project(world_from_camera.Inverse() * Place(), &pixel) == ProjectionStatus::kOk;
    ++images_taken_;
    images_with_it_ += is_in_view ? 1 : 0;
    Image image{now, std::nullopt};
    if (is_in_view) image.sight = Place() - model.truth().world_from_body.translation;
    if (is_in_view) track_.mark = 1;
    return image;
  }

  // The errors are those of the line of sight, in the autopilot's world.
  void Process(const Image& image) {
    constexpr SightErrors kOwn{.direction_rad = 0.005, .position_m = 0.02, .ground_m = 0.05};
    constexpr SightErrors kShared{.direction_rad = 0.005, .position_m = 0, .ground_m = 0.1};
    const auto pose = poses_.Predict(image.captured, std::chrono::milliseconds(100), {});
    if (image.sight && pose) {
      const Eigen::Matrix3d own = GroundCovariance(*image.sight, kOwn);
      const Eigen::Matrix3d shared = GroundCovariance(*image.sight, kShared);
      const Eigen::Vector3d stays(stays_[0], stays_[1], stays_[2]);
      const Eigen::Vector3d now_only(random_.Normal(), random_.Normal(), random_.Normal());
      Eigen::Vector3d place = pose->world_from_body.translation + *image.sight;
      place += own.llt().matrixL() * now_only;
      place += shared.llt().matrixL() * stays;
      const MeasurementFate fate = tracker_.Add({.time = image.captured,
                                                 .position_in_world = place,
                                                 .covariance = own,
                                                 .shared_covariance = shared});
      const bool is_taken = fate == MeasurementFate::kStarted || fate == MeasurementFate::kAccepted;
      if (is_taken) track_.seen = image.captured;
    }
    track_.captured = image.captured;
    track_.state = tracker_.StateAt(image.captured);
    track_.target = tracker_.Predict(image.captured);
  }

  CameraModel lens_;
  FollowOptions follow_;
  Random random_;
  double stays_[3] = {};
  TargetTracker tracker_{FollowPipelineOptions().Tracker()};
  LateImages<Image> images_;
  int orders_ = 0;
  int images_taken_ = 0, images_with_it_ = 0;
};

}  // namespace kestrel
