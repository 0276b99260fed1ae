// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/hunt_pipeline.h"

#include <chrono>
#include <cmath>
#include <utility>

#include "kestrel/core/base/options.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/objects/color/color_grid.h"
#include "kestrel/vision/pipeline/camera_poses.h"
#include "kestrel/vision/pipeline/ground_height.h"
#include "kestrel/vision/pipeline/object_view.h"
#include "kestrel/vision/pipeline/sought_object.h"

namespace kestrel {
namespace {

// Standard deviations for a flight with a given altitude and without an attitude.
constexpr double kTilt_deg = 5;
constexpr double kAltitudeShare = 0.05;

// Error that heights by the size of objects share, like that of the focal length: standard
// deviation, share of the height.
constexpr double kSizeShare = 0.02;

// The given ground is no evidence against objects that contradict it. An object that shows where
// the ground is must therefore have a clear shape and enough pixels.
constexpr double kMaxMisfit = 0.75;
constexpr int kMinPixels = 150;

bool IsClear(const ObjectDetection& detection) {
  return detection.completeness == Completeness::kWhole && detection.misfit <= kMaxMisfit &&
         detection.pixels >= kMinPixels;
}

}  // namespace

class HuntPipeline::Impl {
 public:
  Impl(const CameraCalibration& calibration, const ObjectModel& model, const ColorGrid& grid,
       const HuntPipelineOptions& options);

  PoseStatus AddPose(const PoseSample& sample) { return poses_.Add(sample); }
  PoseStatus AddGimbal(const GimbalSample& sample) { return poses_.Add(sample); }
  void SetAltitude(std::optional<double> altitude_m) { altitude_m_ = altitude_m; }
  void SetGroundZero(double height_m) { ground_zero_m_ = height_m; }
  void ChangeOptions(const HuntPipelineOptions& options);
  void Seek(const std::string& class_name) {
    sought_.emplace(detector_.model(), class_name, options_.map);
  }
  void Assign(const AssignedObject& object) { sought_->Assign(object); }
  void Leave(int number) { sought_->Leave(number); }
  const HuntObservation& Process(const cv::Mat& image, Time time);

  const SoughtObject* sought() const { return sought_ ? &*sought_ : nullptr; }
  const ObjectDetector& detector() const { return detector_; }
  const ObjectMap& map() const { return map_; }
  const HuntPipelineOptions& options() const { return options_; }
  std::optional<GroundHeight> ground_contradiction() const { return ground_.Contradiction(); }

 private:
  // The given heights of camera and ground, in the world or, with an altitude, in a world whose z =
  // 0 is the ground.
  struct GivenHeights {
    double camera_m;
    GroundHeight ground;
  };
  std::optional<GivenHeights> FindGivenHeights() const;

  void TrackSought();
  void Detect(const cv::Mat& image);
  void UpdateGround(const GivenHeights& given);
  void LocateInWorld();
  Eigen::Matrix3d CovarianceOf(std::size_t index) const;
  void UpdateMap();
  void UpdateSought();
  void RememberForTracking();
  Eigen::Vector3d ClockShift(const ObjectDetection& detection) const;
  Time TimeOfRow(double v_px) const;

  HuntPipelineOptions options_;
  ObjectDetector detector_;
  ObjectWorkspace workspace_;
  CameraPoses poses_;
  std::optional<double> altitude_m_;
  double ground_zero_m_ = 0;
  HuntObservation observation_;
  GroundHeightEstimator ground_;
  std::vector<GroundHeight> ground_sightings_;  // sightings of the current frame
  std::vector<TrackedObject> track_;
  bool saw_all_ = true;  // the last frame was searched completely
  ObjectMap map_;
  std::vector<ObjectMeasurement> measurements_;
  std::optional<SoughtObject> sought_;
  std::vector<ObjectSighting> sightings_;  // those of the current frame
};

HuntPipeline::Impl::Impl(const CameraCalibration& calibration, const ObjectModel& model,
                         const ColorGrid& grid, const HuntPipelineOptions& options)
    : options_(Checked(options)),
      detector_(CameraModel(calibration.intrinsics), model, grid, options.detector),
      poses_(calibration, HuntPipelineOptions::kPoseCapacity,
             DurationFromSeconds(options.pose_gap_s), DurationFromSeconds(options.pose_smoothing_s),
             DurationFromSeconds(options.pose_extrapolation_s)),
      map_(model, options.map) {
  RequireFixedLens(calibration, "a hunt");
}

void HuntPipeline::Impl::ChangeOptions(const HuntPipelineOptions& options) {
  RequireValid(options);
  detector_ =
      ObjectDetector(detector_.camera(), detector_.model(), detector_.grid(), options.detector);
  options_ = options;
}

const HuntObservation& HuntPipeline::Impl::Process(const cv::Mat& image, Time time) {
  observation_.time = time;
  observation_.world_from_camera.reset();
  observation_.camera_from_body.reset();
  if (const auto camera = poses_.At(time)) {
    observation_.world_from_camera = camera->world_from_camera;
    observation_.camera_from_body = camera->camera_from_body;
  }
  if (sought_) TrackSought();
  Detect(image);
  LocateInWorld();
  UpdateMap();
  if (sought_) {
    UpdateSought();
  } else {
    RememberForTracking();
  }
  return observation_;
}

// Further away the whole image is searched: the map still grows.
void HuntPipeline::Impl::TrackSought() {
  constexpr double kNear_m = 4;
  track_.clear();
  const auto& world_from_camera = observation_.world_from_camera;
  const auto object = sought_->At(observation_.time);
  if (!world_from_camera || !object) return;
  const Eigen::Vector3d in_camera = world_from_camera->Inverse() * object->motion.position();
  Eigen::Vector2d pixel;
  if (in_camera.norm() > kNear_m ||
      detector_.camera().Project(in_camera, &pixel) != ProjectionStatus::kOk) {
    return;
  }
  track_.push_back({pixel, sought_->class_index()});
}

std::optional<HuntPipeline::Impl::GivenHeights> HuntPipeline::Impl::FindGivenHeights() const {
  if (const auto& world_from_camera = observation_.world_from_camera) {
    return GivenHeights{world_from_camera->translation.z(),
                        {ground_zero_m_ + options_.ground_height_m,
                         std::hypot(options_.pose_sigma_m, options_.ground_sigma_m)}};
  }
  if (!altitude_m_) return std::nullopt;
  return GivenHeights{*altitude_m_,
                      {0, std::hypot(kAltitudeShare * *altitude_m_, options_.ground_sigma_m)}};
}

void HuntPipeline::Impl::Detect(const cv::Mat& image) {
  ObjectHint hint;
  std::optional<GivenHeights> given = FindGivenHeights();
  if (const auto& world_from_camera = observation_.world_from_camera) {
    hint.up_in_camera = world_from_camera->rotation.conjugate() * Eigen::Vector3d::UnitZ();
    hint.up_sigma_rad = Radians(options_.attitude_sigma_deg);
    if (!options_.is_ground_flat) given.reset();
  } else if (given) {
    hint.up_in_camera = -Eigen::Vector3d::UnitZ();
    hint.up_sigma_rad = Radians(kTilt_deg);
  }
  if (given) {
    const GroundHeight ground = options_.still ? given->ground : ground_.Estimate(given->ground);
    hint.camera_height_m = given->camera_m - ground.height_m;
    hint.height_sigma_m = ground.sigma_m;
  }
  hint.track = track_;
  saw_all_ = track_.empty();
  ObjectReport& report = observation_.report;
  const auto start = std::chrono::steady_clock::now();
  detector_.Detect(image, hint, workspace_, &report);
  if (report.detections.size() < track_.size()) {
    hint.track = {};
    saw_all_ = true;
    detector_.Detect(image, hint, workspace_, &report);
  }
  observation_.detect_time = std::chrono::steady_clock::now() - start;
  if (given) UpdateGround(*given);
}

// Objects that agree on another height of the ground overrule the given height.
void HuntPipeline::Impl::UpdateGround(const GivenHeights& given) {
  ObjectReport& report = observation_.report;
  const auto ground_by = [&](const HeightBySize& height, double share) {
    return GroundHeight{given.camera_m - height.camera_height_m,
                        std::hypot(height.sigma_m, share * height.camera_height_m)};
  };
  ground_sightings_.clear();
  for (const auto* detections : {&report.detections, &report.elsewhere}) {
    for (const ObjectDetection& detection : *detections) {
      if (!detection.height || !IsClear(detection)) continue;
      ground_sightings_.push_back(ground_by(*detection.height, kSizeShare));
    }
  }
  // For independent frames and for a flight with only a given altitude.
  if (options_.still || !observation_.world_from_camera) ground_.ForgetSightings();
  ground_.Update(given.ground, ground_sightings_);
  const double tolerance = options_.detector.ground_tolerance / 3;
  std::erase_if(report.elsewhere, [&](const ObjectDetection& detection) {
    if (!ground_.Supports(ground_by(*detection.height, tolerance))) return false;
    report.detections.push_back(detection);
    return true;
  });
}

void HuntPipeline::Impl::LocateInWorld() {
  auto& in_world = observation_.in_world;
  in_world.clear();
  for (const ObjectDetection& detection : observation_.report.detections) {
    in_world.emplace_back();
    if (!detection.location) continue;
    const auto camera = poses_.At(TimeOfRow(detection.center_px.y()));
    if (!camera) continue;
    const RigidTransform& world_from_camera = camera->world_from_camera;
    const Eigen::Matrix3d rotation = world_from_camera.rotation.toRotationMatrix();
    in_world.back() = {world_from_camera * detection.location->position,
                       rotation * detection.location->covariance * rotation.transpose()};
    const double swing_m = camera->uncertainty.attitude_rad * detection.location->position.norm();
    in_world.back()->covariance.diagonal().array() +=
        camera->uncertainty.position_m * camera->uncertainty.position_m + swing_m * swing_m;
  }
}

// Of a detection with a place in the world, with the errors of the navigation.
Eigen::Matrix3d HuntPipeline::Impl::CovarianceOf(std::size_t index) const {
  const ObjectDetection& detection = observation_.report.detections[index];
  const double swing_m = Radians(options_.attitude_sigma_deg) * detection.location->position.norm();
  Eigen::Matrix3d covariance = observation_.in_world[index]->covariance;
  covariance.diagonal().array() +=
      options_.pose_sigma_m * options_.pose_sigma_m + swing_m * swing_m;
  return covariance;
}

void HuntPipeline::Impl::UpdateMap() {
  if (options_.still || !observation_.world_from_camera) return;
  measurements_.clear();
  const auto& detections = observation_.report.detections;
  for (std::size_t i = 0; i < detections.size(); ++i) {
    const ObjectDetection& detection = detections[i];
    const auto& in_world = observation_.in_world[i];
    if (detection.completeness != Completeness::kWhole || !in_world) continue;
    ObjectMeasurement& measurement = measurements_.emplace_back();
    measurement.delay_s = ToSeconds(TimeOfRow(detection.center_px.y()) - observation_.time);
    measurement.position = in_world->position;
    measurement.covariance = CovarianceOf(i);
    measurement.clock_shift = ClockShift(detection);
    measurement.shape = detector_.model().classes[detection.class_index].shape;
    measurement.color = detection.mean_color;
    measurement.color_probabilities = detection.color_probabilities;
    measurement.digits = detection.digits;
  }
  map_.Update(
      observation_.time, measurements_,
      ObjectView(detector_, observation_.report, *observation_.world_from_camera, saw_all_));
}

// One that the image border cuts off counts, too: from near by none is whole. While the UAV turns
// a pose of a moment ago or later puts it elsewhere.
void HuntPipeline::Impl::UpdateSought() {
  constexpr double kLate_s = 0.01;
  sightings_.clear();
  for (std::size_t i = 0; i < observation_.in_world.size(); ++i) {
    if (!observation_.in_world[i]) continue;
    const ObjectDetection& detection = observation_.report.detections[i];
    const Eigen::Vector3d late_m = kLate_s * ClockShift(detection);
    sightings_.push_back({TimeOfRow(detection.center_px.y()), detection.class_index,
                          observation_.in_world[i]->position,
                          CovarianceOf(i) + late_m * late_m.transpose()});
  }
  sought_->Update(observation_.time, sightings_, map_);
}

// See ObjectMeasurement.
Eigen::Vector3d HuntPipeline::Impl::ClockShift(const ObjectDetection& detection) const {
  constexpr double kStep_s = 0.1;  // long enough for the noise of the poses
  const Time time = TimeOfRow(detection.center_px.y());
  const auto camera = poses_.At(time);
  const auto before = poses_.At(time - DurationFromSeconds(kStep_s));
  if (!camera || !before) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d& position = detection.location->position;
  return (camera->world_from_camera * position - before->world_from_camera * position) / kStep_s;
}

void HuntPipeline::Impl::RememberForTracking() {
  track_.clear();
  if (options_.still) return;
  for (const ObjectDetection& detection : observation_.report.detections) {
    if (static_cast<int>(track_.size()) == options_.track_count) return;
    if (detection.completeness != Completeness::kWhole) continue;
    track_.push_back({detection.center_px, detection.class_index});
  }
  if (static_cast<int>(track_.size()) < options_.track_count) track_.clear();
}

Time HuntPipeline::Impl::TimeOfRow(double v_px) const {
  const double share = v_px / (detector_.camera().height_px() - 1) - 0.5;
  return observation_.time + DurationFromSeconds(options_.readout_s * share);
}

HuntPipeline::HuntPipeline(const CameraCalibration& calibration, const ObjectModel& model,
                           const HuntPipelineOptions& options)
    : HuntPipeline(calibration, model, ColorGrid(model.colors), options) {}
HuntPipeline::HuntPipeline(const CameraCalibration& calibration, const ObjectModel& model,
                           const ColorGrid& grid, const HuntPipelineOptions& options)
    : impl_(std::make_unique<Impl>(calibration, model, grid, options)) {}
HuntPipeline::~HuntPipeline() = default;
HuntPipeline::HuntPipeline(HuntPipeline&&) noexcept = default;
HuntPipeline& HuntPipeline::operator=(HuntPipeline&&) noexcept = default;

PoseStatus HuntPipeline::AddPose(const PoseSample& sample) { return impl_->AddPose(sample); }
PoseStatus HuntPipeline::AddGimbal(const GimbalSample& sample) { return impl_->AddGimbal(sample); }
void HuntPipeline::SetAltitude(std::optional<double> altitude_m) { impl_->SetAltitude(altitude_m); }
void HuntPipeline::SetGroundZero(double height_m) { impl_->SetGroundZero(height_m); }
void HuntPipeline::ChangeOptions(const HuntPipelineOptions& options) {
  impl_->ChangeOptions(options);
}
const HuntObservation& HuntPipeline::Process(const cv::Mat& image, Time time) {
  return impl_->Process(image, time);
}
void HuntPipeline::Seek(const std::string& class_name) { impl_->Seek(class_name); }
void HuntPipeline::Assign(const AssignedObject& object) { impl_->Assign(object); }
void HuntPipeline::Leave(int number) { impl_->Leave(number); }
const SoughtObject* HuntPipeline::sought() const { return impl_->sought(); }
const ObjectDetector& HuntPipeline::detector() const { return impl_->detector(); }
const ObjectMap& HuntPipeline::map() const { return impl_->map(); }
const HuntPipelineOptions& HuntPipeline::options() const { return impl_->options(); }
std::optional<GroundHeight> HuntPipeline::ground_contradiction() const {
  return impl_->ground_contradiction();
}

}  // namespace kestrel
