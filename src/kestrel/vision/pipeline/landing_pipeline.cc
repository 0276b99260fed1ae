// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/landing_pipeline.h"

#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/options.h"
#include "kestrel/vision/pipeline/calibration_monitor.h"
#include "kestrel/vision/pipeline/camera_poses.h"
#include "kestrel/vision/pipeline/input_contradictions.h"
#include "kestrel/vision/pipeline/world_location.h"

namespace kestrel {
namespace {

// Nothing where the mount moves, or is not known.
std::optional<RigidTransform> CameraFromBody(const CameraCalibration& calibration) {
  if (calibration.gimbal || !calibration.body_from_camera) return std::nullopt;
  return calibration.body_from_camera->Inverse();
}

}  // namespace

const char* ToString(PositionMethod method) {
  return method == PositionMethod::kSize ? "size" : "altitude";
}

std::string InWords(const OtherTag& other) {
  return fmt::format("no {0} {1}; {0} {2} was seen in {3} frame{4}", other.family, other.wanted_id,
                     other.id, other.frames, other.frames == 1 ? "" : "s");
}

std::string MissInWords(const LandingObservation& observation) {
  if (observation.other_tag) return InWords(*observation.other_tag);
  return std::string(
      MissInWords(observation.report, observation.track_state == TrackState::kTracking));
}

class LandingPipeline::Impl {
 public:
  // 'own_detector': null for the one that the options describe.
  Impl(const CameraCalibration& calibration, std::unique_ptr<const TargetDetector> own_detector,
       const LandingPipelineOptions& options);

  PoseStatus AddPose(const PoseSample& sample) {
    pose_time_sigma_s_ = sample.time_sigma_s;
    return poses_.Add(sample);
  }
  PoseStatus AddGimbal(const GimbalSample& sample) { return poses_.Add(sample); }
  void SetAltitude(std::optional<double> altitude_m) { altitude_m_ = altitude_m; }
  void LimitSearch(double max_search_ms) { max_search_ms_ = max_search_ms; }
  void ChangeOptions(const LandingPipelineOptions& options);
  LandingObservation Process(const cv::Mat& image, Time time);

  const InputContradictions& contradictions() const { return contradictions_; }
  const CalibrationMonitor& calibration_monitor() const { return calibration_monitor_; }
  const TargetTracker& tracker() const { return tracker_; }
  const TargetDetector& detector() const { return *detector_; }
  const LandingPipelineOptions& options() const { return options_; }

 private:
  // Last detection in the camera.
  struct Sighting {
    Time time;
    Eigen::Vector3d center_in_camera;
    std::optional<Eigen::Quaterniond> rotation_in_camera;  // where the pad has a heading
    std::optional<std::int32_t> id;
  };
  // Last detection of a pad with a heading in the world.
  struct Heading {
    Time time;
    Eigen::Quaterniond rotation_in_world;
    std::optional<std::int32_t> id;
    int symmetry;  // number of headings under which the pad looked the same
  };

  // The search for tags of the wrong id.
  struct Others {
    OtherTagFinder finder;
    std::optional<OtherTag> seen;
  };
  static std::optional<Others> OthersOf(const CameraModel& camera, const TargetOptions& target);

  void Detect(const cv::Mat& image, LandingObservation* observation);
  void LookForOthers(const cv::Mat& image, LandingObservation* observation);
  GivenView GivenViewOf(const LandingObservation& observation) const;
  double AltitudeExcess() const;
  void AddErrorOfFocalLength(TargetDetection* detection) const;
  void AddTrack(const LandingObservation& observation, TargetHint* hint) const;
  void AddLastSighting(const LandingObservation& observation, TargetHint* hint) const;
  void LocateInWorld(LandingObservation* observation) const;
  Eigen::Vector3d SweepOf(const LandingObservation& observation) const;
  TargetMeasurement MeasurementOf(const LandingObservation& observation) const;
  void Track(LandingObservation* observation);
  void Remember(const LandingObservation& observation);

  LandingPipelineOptions options_;
  bool is_detector_own_;  // it does not come from the options
  std::unique_ptr<const TargetDetector> detector_;
  std::unique_ptr<TargetWorkspace> workspace_;
  std::optional<Others> others_;  // nothing once the target was found
  CameraPoses poses_;
  std::optional<RigidTransform> fixed_mount_;  // camera from body
  double pose_time_sigma_s_ = 0;
  std::optional<double> altitude_m_;
  TargetTracker tracker_;
  bool is_track_trusted_ = true;  // the last detection was where the track predicted it
  std::optional<Sighting> last_;
  std::optional<Heading> heading_;
  int next_step_ = 0;  // step at which the search of the last frame ran out of time
  double max_search_ms_ = 0;
  InputContradictions contradictions_;
  CalibrationMonitor calibration_monitor_;
};

LandingPipeline::Impl::Impl(const CameraCalibration& calibration,
                            std::unique_ptr<const TargetDetector> own_detector,
                            const LandingPipelineOptions& options)
    : options_(Checked(options)),
      is_detector_own_(own_detector != nullptr),
      detector_(is_detector_own_ ? std::move(own_detector)
                                 : MakeTargetDetector(CameraModel(calibration.intrinsics),
                                                      options.target, options.detector)),
      workspace_(detector_->MakeWorkspace()),
      poses_(calibration, LandingPipelineOptions::kPoseCapacity,
             DurationFromSeconds(options.pose_gap_s), Duration::zero(),
             DurationFromSeconds(options.pose_extrapolation_s)),
      fixed_mount_(CameraFromBody(calibration)),
      tracker_(options.tracker) {
  if (!is_detector_own_) others_ = OthersOf(detector_->camera(), options.target);
}

void LandingPipeline::Impl::ChangeOptions(const LandingPipelineOptions& options) {
  RequireValid(options);
  if (!is_detector_own_) {
    detector_ = MakeTargetDetector(detector_->camera(), options.target, options.detector);
    workspace_ = detector_->MakeWorkspace();
    others_ = OthersOf(detector_->camera(), options.target);
  }
  options_ = options;
}

std::optional<LandingPipeline::Impl::Others> LandingPipeline::Impl::OthersOf(
    const CameraModel& camera, const TargetOptions& target) {
  std::optional<OtherTagFinder> finder = MakeOtherTagFinder(camera, target);
  if (!finder) return std::nullopt;
  return Others{std::move(*finder), std::nullopt};
}

void LandingPipeline::Impl::LookForOthers(const cv::Mat& image, LandingObservation* observation) {
  if (observation->report.detection) others_.reset();
  if (!others_) return;
  const OtherTagFinder& finder = others_->finder;
  if (const auto id = finder.Find(image, workspace_.get())) {
    const std::size_t before =
        others_->seen && others_->seen->id == *id ? others_->seen->frames : 0;
    others_->seen = OtherTag{finder.family(), finder.id(), *id, before + 1};
  }
  observation->other_tag = others_->seen;
}

LandingObservation LandingPipeline::Impl::Process(const cv::Mat& image, Time time) {
  LandingObservation observation;
  observation.time = time;
  observation.camera_from_body = fixed_mount_;
  if (const auto camera = poses_.At(time)) {
    observation.world_from_camera = camera->world_from_camera;
    observation.camera_from_body = camera->camera_from_body;
    observation.pose_uncertainty = camera->uncertainty;
  }
  observation.pose = poses_.Check(time);
  Detect(image, &observation);
  LookForOthers(image, &observation);
  LocateInWorld(&observation);
  if (options_.still) return observation;
  Track(&observation);
  Remember(observation);
  return observation;
}

void LandingPipeline::Impl::Detect(const cv::Mat& image, LandingObservation* observation) {
  const GivenView reported = GivenViewOf(*observation);
  TargetHint hint;
  const double excess_m = AltitudeExcess();
  if (reported.altitude_m > excess_m) hint.altitude_m = *reported.altitude_m - excess_m;
  hint.up_in_camera = reported.up_in_camera;
  if (!options_.still) {
    AddTrack(*observation, &hint);
    AddLastSighting(*observation, &hint);
    hint.first_step = next_step_;
    hint.max_search_ms = max_search_ms_;
  }
  const auto start = std::chrono::steady_clock::now();
  observation->report = detector_->Detect(image, hint, *workspace_);
  observation->detect_time = std::chrono::steady_clock::now() - start;
  next_step_ = observation->report.diagnostics.next_step;
  auto& detection = observation->report.detection;
  if (!detection) return;
  contradictions_.Add(reported, *detection);
  calibration_monitor_.Add(*detection);
  if (!options_.still) AddErrorOfFocalLength(&*detection);
}

// Returns by how much (m) the given altitude is too large, as far as the detections contradict it.
double LandingPipeline::Impl::AltitudeExcess() const {
  if (options_.still) return 0;
  const auto excess = contradictions_.Altitude();
  return excess ? excess->difference : 0;
}

// A wrong focal length makes every distance wrong by the same share. Views that contradict the
// calibration themselves were located with their own focal length and are left alone.
void LandingPipeline::Impl::AddErrorOfFocalLength(TargetDetection* detection) const {
  const auto focal = calibration_monitor_.Contradiction();
  if (!focal || detection->diagnostics.calibration.contradicts) return;
  const Eigen::Vector3d error_m = (focal->factor - 1) * detection->camera_from_target.translation;
  detection->covariance.topLeftCorner<3, 3>() += error_m * error_m.transpose();
}

GivenView LandingPipeline::Impl::GivenViewOf(const LandingObservation& observation) const {
  const auto& world_from_camera = observation.world_from_camera;
  if (!world_from_camera) return {altitude_m_, {}};
  GivenView reported;
  if (options_.altitude_hint) {
    reported.altitude_m = world_from_camera->translation.z() - options_.target_height_m;
  }
  reported.up_in_camera = world_from_camera->rotation.conjugate() * Eigen::Vector3d::UnitZ();
  return reported;
}

void LandingPipeline::Impl::AddTrack(const LandingObservation& observation,
                                     TargetHint* hint) const {
  const auto& world_from_camera = observation.world_from_camera;
  if (!world_from_camera || !is_track_trusted_) return;
  const std::optional<TargetEstimate> target = tracker_.Predict(observation.time);
  if (!target) return;
  const Eigen::Vector3d center = world_from_camera->Inverse() * target->motion.position();
  const PoseUncertainty& pose = observation.pose_uncertainty;
  hint->center_in_camera = center;
  hint->center_sigma_m = options_.hint_sigma_m + target->position_sigma_m() + pose.position_m +
                         pose.attitude_rad * center.norm();
  const double altitude_m = world_from_camera->translation.z() - target->motion.position().z();
  if (altitude_m > 0) hint->altitude_m = altitude_m;
  if (!heading_) return;
  const double turned = target->motion.turn_rate() * ToSeconds(observation.time - heading_->time);
  hint->rotation_in_camera = world_from_camera->rotation.conjugate() *
                             Eigen::AngleAxisd(turned, Eigen::Vector3d::UnitZ()) *
                             heading_->rotation_in_world;
  hint->id = heading_->id;
}

void LandingPipeline::Impl::AddLastSighting(const LandingObservation& observation,
                                            TargetHint* hint) const {
  if (!last_ || observation.world_from_camera) return;
  const double age_s = ToSeconds(observation.time - last_->time);
  if (age_s < 0 || age_s > options_.hint_age_s) return;
  hint->center_in_camera = last_->center_in_camera;
  hint->center_sigma_m = options_.hint_sigma_m + LandingPipelineOptions::kHintSpeed_mps * age_s;
  hint->rotation_in_camera = last_->rotation_in_camera;
  hint->id = last_->id;
}

void LandingPipeline::Impl::LocateInWorld(LandingObservation* observation) const {
  const auto& detection = observation->report.detection;
  const auto& world_from_camera = observation->world_from_camera;
  if (!detection || !world_from_camera) return;
  const RigidTransform world_from_pattern = *world_from_camera * detection->camera_from_target;
  if (detection->heading_symmetry > 0) {
    observation->yaw_in_world = PatternYaw(world_from_pattern, detection->heading_symmetry);
  }
  observation->center_in_world = world_from_pattern.translation;
  if (!options_.position_by_altitude) return;
  Eigen::Vector3d ray_in_camera;
  if (detector_->camera().Unproject(detection->center_px, &ray_in_camera) ==
      ProjectionStatus::kOutsideModel) {
    return;
  }
  const auto by_altitude = LocateByAltitude(ray_in_camera, *world_from_camera,
                                            options_.target_height_m + AltitudeExcess());
  if (!by_altitude) return;
  observation->center_in_world = by_altitude;
  observation->position_method = PositionMethod::kAltitude;
}

// Velocity (m/s) with which the view sweeps over the ground where the pad is seen.
Eigen::Vector3d LandingPipeline::Impl::SweepOf(const LandingObservation& observation) const {
  constexpr Duration kStep = std::chrono::milliseconds(10);
  const auto before = poses_.At(observation.time - kStep);
  if (!before) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d& center = observation.report.detection->camera_from_target.translation;
  return (*observation.world_from_camera * center - before->world_from_camera * center) /
         ToSeconds(kStep);
}

TargetMeasurement LandingPipeline::Impl::MeasurementOf(
    const LandingObservation& observation) const {
  const TargetDetection& detection = *observation.report.detection;
  const Eigen::Vector3d& center = detection.camera_from_target.translation;
  const Eigen::Quaterniond& rotation = observation.world_from_camera->rotation;
  const MeasurementNoise noise = WithPose(options_.noise, observation.pose_uncertainty);
  const double clock_sigma_s = std::hypot(noise.clock_sigma_s, pose_time_sigma_s_);
  const Eigen::Vector3d late_m = clock_sigma_s * SweepOf(observation);
  TargetMeasurement measurement;
  measurement.time = observation.time;
  measurement.position_in_world = *observation.center_in_world;
  measurement.covariance =
      CovarianceInWorld(detection.covariance.topLeftCorner<3, 3>(), center, rotation, noise) +
      late_m * late_m.transpose();
  measurement.shared_covariance = SharedCovarianceInWorld(center, rotation, noise);
  if (!options_.track_yaw || !observation.yaw_in_world) return measurement;
  measurement.yaw = observation.yaw_in_world;
  measurement.yaw_variance =
      YawVarianceInWorld(detection.covariance.bottomRightCorner<3, 3>(), rotation, noise);
  measurement.yaw_period = kFullTurn / detection.heading_symmetry;
  return measurement;
}

void LandingPipeline::Impl::Track(LandingObservation* observation) {
  if (observation->center_in_world) {
    observation->fate = tracker_.Add(MeasurementOf(*observation));
    is_track_trusted_ = observation->fate <= MeasurementFate::kAccepted;
  }
  observation->track_state = tracker_.StateAt(observation->time);
  observation->target = tracker_.Predict(observation->time);
}

void LandingPipeline::Impl::Remember(const LandingObservation& observation) {
  last_.reset();
  if (observation.fate == MeasurementFate::kStarted) heading_.reset();
  const auto& detection = observation.report.detection;
  if (!detection) return;
  const RigidTransform& pose = detection->camera_from_target;
  last_ = {observation.time, pose.translation, {}, detection->id};
  if (detection->heading_symmetry == 0) return;
  last_->rotation_in_camera = pose.rotation;
  if (!observation.world_from_camera || !is_track_trusted_) return;
  // The ring alone does not determine the heading that its tags gave before.
  if (heading_ && heading_->symmetry < detection->heading_symmetry) return;
  heading_ = {observation.time, observation.world_from_camera->rotation * pose.rotation,
              detection->id, detection->heading_symmetry};
}

LandingPipeline::LandingPipeline(const CameraCalibration& calibration,
                                 const LandingPipelineOptions& options)
    : impl_(std::make_unique<Impl>(calibration, nullptr, options)) {}
LandingPipeline::LandingPipeline(const CameraCalibration& calibration,
                                 std::unique_ptr<const TargetDetector> detector,
                                 const LandingPipelineOptions& options)
    : impl_(std::make_unique<Impl>(calibration, std::move(detector), options)) {}
LandingPipeline::~LandingPipeline() = default;
LandingPipeline::LandingPipeline(LandingPipeline&&) noexcept = default;
LandingPipeline& LandingPipeline::operator=(LandingPipeline&&) noexcept = default;

PoseStatus LandingPipeline::AddPose(const PoseSample& sample) { return impl_->AddPose(sample); }
PoseStatus LandingPipeline::AddGimbal(const GimbalSample& sample) {
  return impl_->AddGimbal(sample);
}
void LandingPipeline::SetAltitude(std::optional<double> altitude_m) {
  impl_->SetAltitude(altitude_m);
}
void LandingPipeline::LimitSearch(double max_search_ms) { impl_->LimitSearch(max_search_ms); }
void LandingPipeline::ChangeOptions(const LandingPipelineOptions& options) {
  impl_->ChangeOptions(options);
}
LandingObservation LandingPipeline::Process(const cv::Mat& image, Time time) {
  return impl_->Process(image, time);
}
const InputContradictions& LandingPipeline::contradictions() const {
  return impl_->contradictions();
}
const CalibrationMonitor& LandingPipeline::calibration_monitor() const {
  return impl_->calibration_monitor();
}
const TargetTracker& LandingPipeline::tracker() const { return impl_->tracker(); }
const TargetDetector& LandingPipeline::detector() const { return impl_->detector(); }
const LandingPipelineOptions& LandingPipeline::options() const { return impl_->options(); }

}  // namespace kestrel
