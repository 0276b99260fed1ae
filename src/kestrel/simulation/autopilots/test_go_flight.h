// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/flight/guidance/go_guidance.h"
#include "kestrel/simulation/autopilots/simulated_camera.h"
#include "kestrel/simulation/autopilots/test_late_images.h"
#include "kestrel/simulation/autopilots/test_linked_flight.h"
#include "kestrel/simulation/recordings/recording_plan.h"
#include "kestrel/vision/mapping/object_map.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"
#include "kestrel/vision/pipeline/sought_object.h"

namespace kestrel {

// A field of discs, which may be taken.
inline std::unique_ptr<VehicleWorld> MakeField(const std::vector<std::string>& settings,
                                               std::uint64_t seed) {
  return std::make_unique<VehicleWorld>(ReadVehicleWorld("hunt", settings), kTestStart, seed);
}

// A flight to an object of a class.
struct GoFlightSetup {
  AutopilotFirmware firmware = AutopilotFirmware::kArduPilot;
  AutopilotModelOptions model = {};
  std::vector<std::string> field = {};  // settings of the field
  std::string class_name = "red";
  std::string job = "pick";
  std::optional<Eigen::Vector2d> place = {};  // to which it goes instead; m, world
  std::optional<Eigen::Vector2d> box = {};    // m, world
  FlightOptions flight = {};
  std::uint64_t seed = 1;
  VehicleWorld* world = nullptr;  // with the field of several UAVs; null: one of its own
};

// The field of a flight that has it for itself.
struct OwnField {
  explicit OwnField(const GoFlightSetup& setup) {
    if (setup.world == nullptr) own_field = MakeField(setup.field, setup.seed);
  }

  std::unique_ptr<VehicleWorld> own_field;
};

// A linked flight to an object of a field.
class GoFlight : private OwnField, public LinkedFlight {
 public:
  virtual ~GoFlight() = default;

  // False when the job is not done after so long.
  bool FlyUntilDone(double longest_s) {
    constexpr double kLook_s = 0.5;
    for (double s = 0; s < longest_s && gave_up().empty(); s += kLook_s) {
      Fly(kLook_s);
      if (go_->is_done()) return true;
    }
    return false;
  }
  std::string gave_up() const { return flown_->gave_up(); }
  GuidancePhase phase() const { return flown_->phase(); }
  const std::vector<HuntObject>& field() { return world.field().objects(); }

 protected:
  explicit GoFlight(const GoFlightSetup& setup)
      : OwnField(setup),
        LinkedFlight(setup.firmware, setup.model, own_field ? own_field.get() : setup.world,
                     setup.seed, HuntCalibration()) {
    GoJob job = ParseGoJob(setup.job);
    job.delivers = setup.box.has_value();
    if (setup.place) job.target = GoTarget::kPlace;
    SetPointTask task{.guidance = [this, job](const GuidanceOptions& guidance) {
      auto made = std::make_unique<GoGuidance>(guidance, job);
      go_ = made.get();
      return made;
    }};
    if (setup.box) task.box = OnEarth(setup, *setup.box);
    if (setup.place) task.place = OnEarth(setup, *setup.place);
    FlyBySetPoints(setup.flight, {}, task);
  }

  void Show(Time captured, const SoughtObject& sought) {
    track_.captured = captured;
    track_.mark = sought.number();
    track_.state = sought.StateAt(captured);
    track_.target = sought.At(captured);
    track_.seen = sought.seen();
  }

 private:
  static GlobalPosition OnEarth(const GoFlightSetup& setup, const Eigen::Vector2d& place) {
    const GlobalOrigin& origin = setup.model.origin;
    const GlobalPosition at{static_cast<std::int32_t>(std::lround(1e7 * origin.latitude_deg)),
                            static_cast<std::int32_t>(std::lround(1e7 * origin.longitude_deg)),
                            origin.altitude_m};
    const AutopilotKind kind =
        setup.firmware == AutopilotFirmware::kPx4 ? AutopilotKind::kPx4 : AutopilotKind::kArduPilot;
    return GlobalFromLocal(kind, at, {place.x(), place.y(), 0});
  }

  const GoGuidance* go_ = nullptr;
};

// One that sees rendered images: all that flies is what `kestrel fly` flies.
class RenderedGoFlight : public GoFlight {
 public:
  explicit RenderedGoFlight(const GoFlightSetup& setup)
      : GoFlight(setup),
        renderer_({}, &world, kTestStart, setup.seed),
        pipeline_(renderer_.calibration(), DefaultObjectModel(), Options()) {
    pipeline_.Seek(setup.class_name);
  }

 private:
  static HuntPipelineOptions Options() {
    HuntPipelineOptions options;
    options.pose_extrapolation_s = 0.2;
    return options;
  }

  void TakePose(const PoseSample& pose) override { pipeline_.AddPose(pose); }

  void See() override {
    constexpr Duration kPeriod = std::chrono::milliseconds(100);
    constexpr Duration kLatency = std::chrono::milliseconds(40);
    if (now >= capture_due_) {
      capture_due_ = now + kPeriod;
      if (auto frame = renderer_.Capture(now)) frames_.push_back(std::move(*frame));
    }
    if (frames_.empty() || now < frames_.front().time + kLatency) return;
    pipeline_.Process(frames_.front().image, frames_.front().time);
    Show(frames_.front().time, *pipeline_.sought());
    frames_.pop_front();
  }

  SimulatedCamera renderer_;
  HuntPipeline pipeline_;
  std::deque<Frame> frames_;
  Time capture_due_{};
};

// One without images: it gets the true objects in view, with the errors of a detection, by the map
// and the track of the sought one that fly.
class SightedGoFlight : public GoFlight {
 public:
  explicit SightedGoFlight(const GoFlightSetup& setup)
      : GoFlight(setup),
        lens_(camera_.intrinsics),
        random_(setup.seed),
        sought_(objects_, setup.class_name, {}) {}

 protected:
  ObjectModel objects_ = DefaultObjectModel();
  ObjectMap map_{objects_, {}};

 private:
  struct Sight {
    std::size_t class_index;
    Eigen::Vector3d in_camera;
    bool is_whole;
  };
  struct Image {
    Time captured;
    std::vector<Sight> sights;
  };
  // Of the objects well inside of the image.
  struct View : FieldOfView {
    bool Shows(const MappedObject& object) const override {
      Eigen::Vector2d pixel;
      constexpr double kMargin_px = 60;
      return lens->Project(camera_from_world * object.position(), &pixel) ==
                 ProjectionStatus::kOk &&
             (pixel.array() > kMargin_px).all() && pixel.x() < lens->width_px() - kMargin_px &&
             pixel.y() < lens->height_px() - kMargin_px;
    }
    const CameraModel* lens;
    RigidTransform camera_from_world;
  };

  void See() override {
    images_.See(
        now, [this] { return Capture(); }, [this](const Image& image) { Process(image); });
  }

  // An object is seen while its middle is in view, and is whole while all of it is.
  Image Capture() {
    Image image{now, {}};
    const RigidTransform camera_from_world = WorldFromCamera().Inverse();
    for (std::size_t i = 0; i < field().size(); ++i) {
      const HuntObject& object = field()[i];
      if (world.field().is_taken(i)) continue;
      const Eigen::Vector3d in_camera =
          camera_from_world * object.center(world.SceneTime(model.truth().time));
      Eigen::Vector2d pixel;
      if (lens_.Project(in_camera, &pixel) != ProjectionStatus::kOk) continue;
      const double radius_px = Focal() * object.half_size.x() / in_camera.z();
      constexpr double kSmallest_px = 3.5;
      if (radius_px < kSmallest_px) continue;
      const double inside_px = std::min({pixel.x(), pixel.y(), lens_.width_px() - 1 - pixel.x(),
                                         lens_.height_px() - 1 - pixel.y()});
      image.sights.push_back({ClassOfColor(object.color), in_camera, inside_px > radius_px});
    }
    return image;
  }

  // In the autopilot's world, by its poses.
  std::optional<RigidTransform> WorldFromCameraAt(Time time) const {
    const auto pose = poses_.Predict(time, std::chrono::milliseconds(100), {});
    if (!pose) return std::nullopt;
    return pose->world_from_body * *camera_.body_from_camera;
  }

  // Errors across the line of sight and along it, and those that HuntPipeline expects of the poses.
  void Process(const Image& image) {
    constexpr double kAcross_px = 0.3, kAlong = 0.01, kLeast_m = 0.002, kPose_m = 0.02;
    constexpr double kSwing = 0.0035, kLate_s = 0.01;
    constexpr Duration kStep = std::chrono::milliseconds(100);
    const auto camera = WorldFromCameraAt(image.captured);
    const auto before = WorldFromCameraAt(image.captured - kStep);
    if (!camera || !before) return;
    const RigidTransform& world_from_camera = *camera;
    std::vector<ObjectMeasurement> measurements;
    std::vector<ObjectSighting> sightings;
    for (const Sight& sight : image.sights) {
      const double depth_m = sight.in_camera.z();
      const double across_m = kLeast_m + kAcross_px / Focal() * depth_m;
      const Eigen::Vector3d sigmas(across_m, across_m, kLeast_m + kAlong * depth_m);
      const Eigen::Vector3d noise(random_.Normal(), random_.Normal(), random_.Normal());
      ObjectMeasurement seen;
      seen.position = world_from_camera * (sight.in_camera + sigmas.cwiseProduct(noise));
      const Eigen::Matrix3d rotation = world_from_camera.rotation.toRotationMatrix();
      const double pose_m = std::hypot(kPose_m, kSwing * depth_m);
      seen.covariance = rotation * sigmas.cwiseAbs2().asDiagonal() * rotation.transpose() +
                        pose_m * pose_m * Eigen::Matrix3d::Identity();
      seen.color_probabilities[objects_.classes[sight.class_index].color] = 0.95;
      const Eigen::Vector3d late_m =
          kLate_s / ToSeconds(kStep) * (seen.position - *before * sight.in_camera);
      sightings.push_back({image.captured, sight.class_index, seen.position,
                           seen.covariance + late_m * late_m.transpose()});
      if (sight.is_whole) measurements.push_back(seen);
    }
    View view;
    view.lens = &lens_;
    view.camera_from_world = world_from_camera.Inverse();
    map_.Update(image.captured, measurements, view);
    LeaveEnded();
    sought_.Update(image.captured, sightings, map_);
    Show(image.captured, sought_);
  }

  virtual void LeaveEnded() { sought_.Leave(flown_->by_position()->ended().mark); }

  double Focal() const { return camera_.intrinsics.fx_px; }

  std::size_t ClassOfColor(const std::string& color) const {
    std::size_t i = 0;
    while (objects_.classes[i].name != color || objects_.classes[i].shape != ObjectShape::kDisc)
      ++i;
    return i;
  }

  CameraModel lens_;
  Random random_;

 protected:
  SoughtObject sought_;

 private:
  LateImages<Image> images_;
};

}  // namespace kestrel
