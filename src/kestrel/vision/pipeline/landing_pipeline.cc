// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/landing_pipeline.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kestrel/core/base/options.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/pipeline/calibration_monitor.h"
#include "kestrel/vision/pipeline/camera_lag.h"
#include "kestrel/vision/pipeline/camera_lens.h"
#include "kestrel/vision/pipeline/camera_poses.h"
#include "kestrel/vision/pipeline/camera_watch.h"
#include "kestrel/vision/pipeline/gimbal_bias.h"
#include "kestrel/vision/pipeline/input_contradictions.h"
#include "kestrel/vision/pipeline/stamp_lag.h"
#include "kestrel/vision/pipeline/world_location.h"

namespace kestrel {
namespace {

// Nothing where the mount moves, or is not known.
std::optional<RigidTransform> CameraFromBody(const CameraCalibration& calibration) {
  if (calibration.gimbal || !calibration.body_from_camera) return std::nullopt;
  return calibration.body_from_camera->Inverse();
}

// What all images of a camera share, others do not: errors of its mount and of its lens.
Eigen::Matrix3d BetweenCameras(const Eigen::Vector3d& center_in_camera,
                               const Eigen::Quaterniond& world_from_camera,
                               MeasurementNoise noise) {
  noise.pose_bias_m = 0;
  return SharedCovarianceInWorld(center_in_camera, world_from_camera, noise);
}

std::vector<std::unique_ptr<const TargetDetector>> ListOf(
    std::unique_ptr<const TargetDetector> detector) {
  std::vector<std::unique_ptr<const TargetDetector>> list;
  list.push_back(std::move(detector));
  return list;
}

Duration ClockOffset(const CameraCalibration& calibration) {
  return calibration.clock_offset.value_or(Duration::zero());
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
  // 'own_detectors': of each camera; none for those that the options describe.
  Impl(std::span<const CameraCalibration> cameras,
       std::vector<std::unique_ptr<const TargetDetector>> own_detectors,
       const LandingPipelineOptions& options);

  PoseStatus AddPose(const PoseSample& sample);
  PoseStatus AddGimbal(const GimbalSample& sample);
  PoseStatus AddZoom(const ZoomSample& sample);
  void SetAltitude(std::optional<double> altitude_m) { altitude_m_ = altitude_m; }
  void LimitSearch(double max_search_ms) { max_search_ms_ = max_search_ms; }
  void ChangeOptions(const LandingPipelineOptions& options);
  LandingObservation Process(const cv::Mat& image, Time time, std::size_t camera);

  std::size_t camera_count() const { return eyes_.size(); }
  const CameraState& camera_state(std::size_t camera) const { return watch_.state(camera); }
  const InputContradictions& contradictions(std::size_t i) const { return eyes_[i].contradictions; }
  const CalibrationMonitor& calibration_monitor(std::size_t i) const {
    return eyes_[i].calibration;
  }
  const TargetTracker& tracker() const { return tracker_; }
  const TargetDetector& detector(std::size_t camera) const { return *eyes_[camera].detector; }
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

  // One camera, and what is remembered of its own images.
  struct Eye {
    // 'clock_offset': of the first camera's images.
    Eye(const CameraCalibration& camera, std::unique_ptr<const TargetDetector> target_detector,
        const LandingPipelineOptions& options, Duration clock_offset);

    Time OwnTime(const LandingObservation& observation) const { return observation.time - ahead; }

    std::unique_ptr<const TargetDetector> detector;
    std::unique_ptr<TargetWorkspace> workspace;
    std::optional<Others> others;  // nothing once the target was found
    CameraPoses poses;
    Duration ahead;  // the first camera's clock minus that of this camera's images
    CameraLag lag;   // late stamps, beside 'ahead'; none of the first camera, which is the clock
    StampLag stamp_lag;  // what its sightings alone say about the stamps; of several cameras
    std::optional<GimbalBias> gimbal_bias;           // nothing: the mount is fixed
    std::optional<CameraLens> zoom;                  // nothing: the lens is fixed
    double view_rad = 0;                             // what the detector sees, where it zooms
    std::shared_ptr<const CameraModel> zoomed_lens;  // that lens; null until it is known
    std::optional<RigidTransform> fixed_mount;       // camera from body
    bool is_track_trusted = true;  // the last detection was where the track predicted it
    std::optional<Sighting> last;
    int next_step = 0;  // step at which the search of the last frame ran out of time
    int misses = 0;     // whole searches since the pad was found
    InputContradictions contradictions;
    CalibrationMonitor calibration;
  };

  bool has_several() const { return eyes_.size() > 1; }
  bool IsUsed(std::size_t camera) const { return !has_several() || watch_.IsUsed(camera); }
  bool IsJudged(std::size_t camera) const { return !has_several() || watch_.IsJudged(camera); }
  static void SetDetector(const CameraModel& camera, const LandingPipelineOptions& options,
                          Eye* eye);
  bool FollowZoom(const cv::Mat& image, Time time, Eye* eye) const;
  void Detect(const cv::Mat& image, Eye* eye, LandingObservation* observation) const;
  void LookForOthers(const cv::Mat& image, Eye* eye, LandingObservation* observation);
  GivenView GivenViewOf(const LandingObservation& observation) const;
  static std::optional<double> SkyAbove(const Eye& eye, const LandingObservation& observation);
  double AltitudeExcess(const Eye& eye) const;
  static void AddErrorOfFocalLength(const Eye& eye, TargetDetection* detection);
  void AddTrack(const Eye& eye, const LandingObservation& observation, TargetHint* hint) const;
  void AddLastSighting(const Eye& eye, const LandingObservation& observation,
                       TargetHint* hint) const;
  void LocateInWorld(const Eye& eye, LandingObservation* observation) const;
  static Eigen::Vector3d SweepOf(const Eye& eye, const LandingObservation& observation);
  TargetMeasurement MeasurementOf(const Eye& eye, const LandingObservation& observation) const;
  void Track(Eye* eye, LandingObservation* observation);
  void LearnGimbalBias(const TargetMeasurement& measurement, const LandingObservation& observation,
                       Eye* eye) const;
  double LagSigma_s() const;
  void TrackWithOthers(TargetMeasurement measurement, Eye* eye, LandingObservation* observation);
  void Judge(const TargetMeasurement& measurement, const Eigen::Vector3d& slip_mps,
             const std::optional<TargetEstimate>& expected, const LandingObservation& observation,
             Eye* eye);
  bool IsRefuted(std::size_t camera, std::size_t other) const;
  void Remember(const LandingObservation& observation, Eye* eye);

  LandingPipelineOptions options_;
  bool are_detectors_own_;  // they do not come from the options
  std::vector<Eye> eyes_;
  CameraWatch watch_;  // watches several cameras
  double pose_time_sigma_s_ = 0;
  std::optional<double> altitude_m_;
  TargetTracker tracker_;
  std::optional<Heading> heading_;
  double max_search_ms_ = 0;
};

LandingPipeline::Impl::Eye::Eye(const CameraCalibration& camera,
                                std::unique_ptr<const TargetDetector> target_detector,
                                const LandingPipelineOptions& options, Duration clock_offset)
    : detector(std::move(target_detector)),
      workspace(detector->MakeWorkspace()),
      poses(camera, LandingPipelineOptions::kPoseCapacity, DurationFromSeconds(options.pose_gap_s),
            Duration::zero(), DurationFromSeconds(options.pose_extrapolation_s)),
      ahead(ClockOffset(camera) - clock_offset),
      fixed_mount(CameraFromBody(camera)) {
  if (camera.gimbal) gimbal_bias.emplace();
  if (camera.zoom) zoom.emplace(camera, LandingPipelineOptions::kPoseCapacity);
}

LandingPipeline::Impl::Impl(std::span<const CameraCalibration> cameras,
                            std::vector<std::unique_ptr<const TargetDetector>> own_detectors,
                            const LandingPipelineOptions& options)
    : options_(Checked(options)),
      are_detectors_own_(!own_detectors.empty()),
      watch_(cameras.size()),
      tracker_(options.tracker) {
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    eyes_.emplace_back(cameras[i],
                       are_detectors_own_ ? std::move(own_detectors.at(i))
                                          : MakeTargetDetector(CameraModel(cameras[i].intrinsics),
                                                               options.target, options.detector),
                       options, ClockOffset(cameras.front()));
    if (are_detectors_own_ && cameras[i].zoom) {
      throw InputError("a camera that zooms has a detector of its own, expected one by options");
    }
    if (are_detectors_own_) continue;
    eyes_.back().others = OthersOf(eyes_.back().detector->camera(), options.target);
  }
}

void LandingPipeline::Impl::ChangeOptions(const LandingPipelineOptions& options) {
  RequireValid(options);
  for (Eye& eye : eyes_) {
    if (are_detectors_own_) break;
    SetDetector(eye.detector->camera(), options, &eye);
    eye.others = OthersOf(eye.detector->camera(), options.target);
  }
  options_ = options;
}

void LandingPipeline::Impl::SetDetector(const CameraModel& camera,
                                        const LandingPipelineOptions& options, Eye* eye) {
  eye->detector = MakeTargetDetector(camera, options.target, options.detector);
  eye->workspace = eye->detector->MakeWorkspace();
}

// Gives the detector the lens of this image; false where that moves or is not known.
bool LandingPipeline::Impl::FollowZoom(const cv::Mat& image, Time time, Eye* eye) const {
  constexpr double kSame = 0.005;  // as a share of the view
  const auto view_rad = eye->zoom->ViewAt(image, time);
  if (!view_rad) return false;
  if (std::abs(*view_rad - eye->view_rad) <= kSame * *view_rad) return true;
  const auto lens = eye->zoom->LensOf(*view_rad);
  if (!lens) return false;
  eye->view_rad = *view_rad;
  eye->zoomed_lens = std::make_shared<const CameraModel>(*lens);
  SetDetector(*eye->zoomed_lens, options_, eye);
  if (eye->others) eye->others = OthersOf(*eye->zoomed_lens, options_.target);
  eye->calibration = CalibrationMonitor();
  return true;
}

PoseStatus LandingPipeline::Impl::AddPose(const PoseSample& sample) {
  pose_time_sigma_s_ = sample.time_sigma_s;
  PoseStatus status{};
  for (Eye& eye : eyes_) status = eye.poses.Add(sample);
  return status;
}

PoseStatus LandingPipeline::Impl::AddGimbal(const GimbalSample& sample) {
  PoseStatus status{};
  for (Eye& eye : eyes_) status = eye.poses.Add(sample);
  return status;
}

PoseStatus LandingPipeline::Impl::AddZoom(const ZoomSample& sample) {
  PoseStatus status{};
  for (Eye& eye : eyes_) {
    if (eye.zoom) status = eye.zoom->Add(sample);
  }
  return status;
}

std::optional<LandingPipeline::Impl::Others> LandingPipeline::Impl::OthersOf(
    const CameraModel& camera, const TargetOptions& target) {
  std::optional<OtherTagFinder> finder = MakeOtherTagFinder(camera, target);
  if (!finder) return std::nullopt;
  return Others{std::move(*finder), std::nullopt};
}

void LandingPipeline::Impl::LookForOthers(const cv::Mat& image, Eye* eye,
                                          LandingObservation* observation) {
  if (observation->report.detection) {
    for (Eye& each : eyes_) each.others.reset();
  }
  auto& others = eye->others;
  if (!others) return;
  const OtherTagFinder& finder = others->finder;
  if (const auto id = finder.Find(image, eye->workspace.get())) {
    const std::size_t before = others->seen && others->seen->id == *id ? others->seen->frames : 0;
    others->seen = OtherTag{finder.family(), finder.id(), *id, before + 1};
  }
  observation->other_tag = others->seen;
}

LandingObservation LandingPipeline::Impl::Process(const cv::Mat& image, Time time,
                                                  std::size_t camera) {
  Eye& eye = eyes_[camera];
  LandingObservation observation;
  observation.time = time + eye.ahead;
  observation.camera = camera;
  observation.camera_from_body = eye.fixed_mount;
  if (const auto pose = eye.poses.At(time)) {
    observation.world_from_camera = pose->world_from_camera;
    observation.camera_from_body = pose->camera_from_body;
    observation.pose_uncertainty = pose->uncertainty;
  }
  observation.pose = eye.poses.Check(time);
  if (has_several()) watch_.AddFrame(camera, image, observation.time);
  observation.is_zooming = eye.zoom && !FollowZoom(image, time, &eye);
  if (observation.is_zooming) {
    observation.report.reason = "the lens zooms, or its setting is not known";
  } else {
    observation.zoomed_lens = eye.zoomed_lens;
    Detect(image, &eye, &observation);
    LookForOthers(image, &eye, &observation);
  }
  LocateInWorld(eye, &observation);
  if (options_.still) return observation;
  Track(&eye, &observation);
  Remember(observation, &eye);
  return observation;
}

void LandingPipeline::Impl::Detect(const cv::Mat& image, Eye* eye,
                                   LandingObservation* observation) const {
  const GivenView given = GivenViewOf(*observation);
  TargetHint hint;
  const double excess_m = AltitudeExcess(*eye);
  if (given.altitude_m > excess_m) hint.altitude_m = *given.altitude_m - excess_m;
  hint.up_in_camera = given.up_in_camera;
  if (!options_.still) {
    AddTrack(*eye, *observation, &hint);
    AddLastSighting(*eye, *observation, &hint);
    hint.first_step = eye->next_step;
    hint.max_search_ms = max_search_ms_;
    hint.sky_above_rad = SkyAbove(*eye, *observation);
  }
  const auto start = std::chrono::steady_clock::now();
  observation->report = eye->detector->Detect(image, hint, *eye->workspace);
  observation->detect_time = std::chrono::steady_clock::now() - start;
  eye->next_step = observation->report.diagnostics.next_step;
  auto& detection = observation->report.detection;
  // A search that ran out of time goes on in the same part.
  if (detection) {
    eye->misses = 0;
  } else if (eye->next_step == 0) {
    ++eye->misses;
  }
  if (!detection) return;
  if (IsJudged(observation->camera)) eye->contradictions.Add(given, *detection);
  if (IsUsed(observation->camera)) eye->calibration.Add(*detection);
  if (!options_.still) AddErrorOfFocalLength(*eye, &*detection);
}

// From where on (rad above the horizon) the image is left out of the search: of three frames in
// four, because an attitude that is wrong, such as that of a camera upside down, must not hide the
// pad; and of none where the pad has shown that it is wrong.
std::optional<double> LandingPipeline::Impl::SkyAbove(const Eye& eye,
                                                      const LandingObservation& observation) {
  constexpr double kSigmas = 3;
  constexpr int kRound = 4;
  if (eye.misses % kRound == kRound - 1 || eye.contradictions.Attitude()) return std::nullopt;
  return kSkyMargin_rad + kSigmas * observation.pose_uncertainty.attitude_rad;
}

// Returns by how much (m) the given altitude is too large, as far as the detections contradict it.
double LandingPipeline::Impl::AltitudeExcess(const Eye& eye) const {
  if (options_.still) return 0;
  const auto excess = eye.contradictions.Altitude();
  return excess ? excess->difference : 0;
}

// A wrong focal length makes every distance wrong by the same share. Views that contradict the
// calibration themselves were located with their own focal length and are left alone.
void LandingPipeline::Impl::AddErrorOfFocalLength(const Eye& eye, TargetDetection* detection) {
  const auto focal = eye.calibration.Contradiction();
  if (!focal || detection->diagnostics.calibration.contradicts) return;
  const Eigen::Vector3d error_m = (focal->factor - 1) * detection->camera_from_target.translation;
  detection->covariance.topLeftCorner<3, 3>() += error_m * error_m.transpose();
}

GivenView LandingPipeline::Impl::GivenViewOf(const LandingObservation& observation) const {
  const auto& world_from_camera = observation.world_from_camera;
  if (!world_from_camera) return {altitude_m_, {}};
  GivenView given;
  if (options_.altitude_hint) {
    given.altitude_m = world_from_camera->translation.z() - options_.target_height_m;
  }
  given.up_in_camera = world_from_camera->rotation.conjugate() * Eigen::Vector3d::UnitZ();
  return given;
}

void LandingPipeline::Impl::AddTrack(const Eye& eye, const LandingObservation& observation,
                                     TargetHint* hint) const {
  const auto& world_from_camera = observation.world_from_camera;
  if (!world_from_camera || !eye.is_track_trusted) return;
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

void LandingPipeline::Impl::AddLastSighting(const Eye& eye, const LandingObservation& observation,
                                            TargetHint* hint) const {
  const auto& last = eye.last;
  if (!last || observation.world_from_camera) return;
  const double age_s = ToSeconds(observation.time - last->time);
  if (age_s < 0 || age_s > options_.hint_age_s) return;
  hint->center_in_camera = last->center_in_camera;
  hint->center_sigma_m = options_.hint_sigma_m + LandingPipelineOptions::kHintSpeed_mps * age_s;
  hint->rotation_in_camera = last->rotation_in_camera;
  hint->id = last->id;
}

void LandingPipeline::Impl::LocateInWorld(const Eye& eye, LandingObservation* observation) const {
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
  if (eye.detector->camera().Unproject(detection->center_px, &ray_in_camera) ==
      ProjectionStatus::kOutsideModel) {
    return;
  }
  const auto by_altitude = LocateByAltitude(ray_in_camera, *world_from_camera,
                                            options_.target_height_m + AltitudeExcess(eye));
  if (!by_altitude) return;
  observation->center_in_world = by_altitude;
  observation->position_method = PositionMethod::kAltitude;
}

// Velocity (m/s) with which the view sweeps over the ground where the pad is seen.
Eigen::Vector3d LandingPipeline::Impl::SweepOf(const Eye& eye,
                                               const LandingObservation& observation) {
  constexpr Duration kStep = std::chrono::milliseconds(10);
  const auto before = eye.poses.At(eye.OwnTime(observation) - kStep);
  if (!before) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d& center = observation.report.detection->camera_from_target.translation;
  return (*observation.world_from_camera * center - before->world_from_camera * center) /
         ToSeconds(kStep);
}

TargetMeasurement LandingPipeline::Impl::MeasurementOf(
    const Eye& eye, const LandingObservation& observation) const {
  const TargetDetection& detection = *observation.report.detection;
  const Eigen::Vector3d& center = detection.camera_from_target.translation;
  const Eigen::Quaterniond& rotation = observation.world_from_camera->rotation;
  const MeasurementNoise noise = WithPose(options_.noise, observation.pose_uncertainty);
  const double clock_sigma_s = std::hypot(noise.clock_sigma_s, pose_time_sigma_s_);
  const Eigen::Vector3d late_m = clock_sigma_s * SweepOf(eye, observation);
  TargetMeasurement measurement;
  measurement.time = observation.time;
  measurement.position_in_world = *observation.center_in_world;
  measurement.covariance =
      CovarianceInWorld(detection.covariance.topLeftCorner<3, 3>(), center, rotation, noise) +
      late_m * late_m.transpose();
  measurement.shared_covariance = SharedCovarianceInWorld(center, rotation, noise);
  if (has_several()) measurement.covariance += BetweenCameras(center, rotation, noise);
  if (!options_.track_yaw || !observation.yaw_in_world) return measurement;
  measurement.yaw = observation.yaw_in_world;
  measurement.yaw_variance =
      YawVarianceInWorld(detection.covariance.bottomRightCorner<3, 3>(), rotation, noise);
  measurement.yaw_period = kFullTurn / detection.heading_symmetry;
  return measurement;
}

// Returns the standard deviation of the lag between two cameras. Whichever is late, the track is
// made of both.
double LandingPipeline::Impl::LagSigma_s() const {
  double sigma_s = 0;
  for (const Eye& eye : std::span(eyes_).subspan(1)) {
    sigma_s = std::max(sigma_s, eye.lag.sigma_s());
  }
  return sigma_s;
}

void LandingPipeline::Impl::Track(Eye* eye, LandingObservation* observation) {
  if (!IsUsed(observation->camera)) eye->is_track_trusted = false;
  if (observation->center_in_world) {
    const TargetMeasurement measurement = MeasurementOf(*eye, *observation);
    if (has_several()) {
      TrackWithOthers(measurement, eye, observation);
    } else {
      observation->fate = tracker_.Add(measurement);
    }
    LearnGimbalBias(measurement, *observation, eye);
    if (observation->fate) eye->is_track_trusted = observation->fate <= MeasurementFate::kAccepted;
  }
  observation->track_state = tracker_.StateAt(observation->time);
  observation->target = tracker_.Predict(observation->time);
}

void LandingPipeline::Impl::LearnGimbalBias(const TargetMeasurement& measurement,
                                            const LandingObservation& observation, Eye* eye) const {
  constexpr double kStands_mps = 0.15;
  if (!eye->gimbal_bias || observation.fate != MeasurementFate::kAccepted) return;
  if (observation.position_method != PositionMethod::kSize) return;
  const auto target = tracker_.Predict(observation.time);
  if (!target || target->motion.velocity().norm() + target->velocity_sigma_mps() > kStands_mps) {
    return eye->gimbal_bias->Forget();
  }
  eye->poses.TurnOnGimbal(eye->gimbal_bias->Add(
      {observation.time, observation.report.detection->camera_from_target.translation,
       observation.world_from_camera->rotation, measurement.position_in_world,
       measurement.covariance, options_.noise.pose_bias_m}));
}

// A camera whose stamps are late shows the target where its view was, and the target, before.
void LandingPipeline::Impl::TrackWithOthers(TargetMeasurement measurement, Eye* eye,
                                            LandingObservation* observation) {
  if (!watch_.IsJudged(observation->camera)) return;
  eye->stamp_lag.Add(eye->OwnTime(*observation),
                     observation->report.detection->camera_from_target.translation,
                     std::sqrt(measurement.covariance.topLeftCorner<2, 2>().trace() / 2));
  const auto expected = tracker_.Predict(observation->time);
  Eigen::Vector3d slip_mps = Eigen::Vector3d::Zero();
  if (expected) {
    slip_mps = SweepOf(*eye, *observation) - expected->motion.velocity();
    const Eigen::Vector3d uncertain_m = LagSigma_s() * slip_mps;
    measurement.position_in_world -= eye->lag.seconds() * slip_mps;
    measurement.covariance += uncertain_m * uncertain_m.transpose();
  }
  if (IsUsed(observation->camera)) observation->fate = tracker_.Add(measurement);
  Judge(measurement, slip_mps, expected, *observation, eye);
}

// 'expected': the track without the measurement; 'slip_mps': see CameraLag.
void LandingPipeline::Impl::Judge(const TargetMeasurement& measurement,
                                  const Eigen::Vector3d& slip_mps,
                                  const std::optional<TargetEstimate>& expected,
                                  const LandingObservation& observation, Eye* eye) {
  constexpr double kFarthest_rad = 0.3;  // the most that mounts explain: beyond is another thing
  constexpr Duration kFresh = std::chrono::milliseconds(500);
  CameraSighting sighting{observation.time};
  if (observation.fate != MeasurementFate::kStarted) {
    if (!expected) return;
    const Eigen::Vector3d offset_m = measurement.position_in_world - expected->motion.position();
    const RigidTransform& world_from_camera = *observation.world_from_camera;
    sighting = SightingBy(
        {measurement.position_in_world - world_from_camera.translation, measurement.covariance,
         offset_m, expected->position_sigma_m(), LagSigma_s() * slip_mps},
        (world_from_camera.rotation * observation.camera_from_body->rotation).conjugate(),
        observation.time);
    if (sighting.offset_m > kFarthest_rad * sighting.distance_m) return;
    // A mount that is wrong makes larger offsets than noise and lag do.
    const bool may_be_late = sighting.offset_m < CameraSighting::kSigmas * sighting.sigma_m;
    if (may_be_late && eye != &eyes_.front() &&
        watch_.IsSeenByOthers(observation.camera, observation.time, kFresh)) {
      eye->lag.Add(offset_m, slip_mps,
                   measurement.covariance + expected->motion.covariance.topLeftCorner<3, 3>());
    }
  }
  const bool is_one_left_out = watch_.AddSighting(
      observation.camera, sighting,
      [this](std::size_t camera, std::size_t other) { return IsRefuted(camera, other); });
  if (!is_one_left_out) return;
  for (Eye& each : eyes_) each.lag = {};  // it was learnt from the wrong camera, too
}

// Whether the stamps of 'camera' show that it is the one of the two that is wrong.
bool LandingPipeline::Impl::IsRefuted(std::size_t camera, std::size_t other) const {
  const auto is_late = [this](std::size_t index) {
    const Eye& eye = eyes_[index];
    return eye.stamp_lag.Contradiction(eye.poses).has_value();
  };
  return is_late(camera) && !is_late(other);
}

void LandingPipeline::Impl::Remember(const LandingObservation& observation, Eye* eye) {
  eye->last.reset();
  if (observation.fate == MeasurementFate::kStarted) heading_.reset();
  const auto& detection = observation.report.detection;
  if (!detection) return;
  const RigidTransform& pose = detection->camera_from_target;
  eye->last = {observation.time, pose.translation, {}, detection->id};
  if (detection->heading_symmetry == 0) return;
  eye->last->rotation_in_camera = pose.rotation;
  if (!observation.world_from_camera || !eye->is_track_trusted) return;
  // The ring alone does not determine the heading that its tags gave before.
  if (heading_ && heading_->symmetry < detection->heading_symmetry) return;
  heading_ = {observation.time, observation.world_from_camera->rotation * pose.rotation,
              detection->id, detection->heading_symmetry};
}

LandingPipeline::LandingPipeline(const CameraCalibration& calibration,
                                 const LandingPipelineOptions& options)
    : LandingPipeline(std::span(&calibration, 1), options) {}
LandingPipeline::LandingPipeline(const CameraCalibration& calibration,
                                 std::unique_ptr<const TargetDetector> detector,
                                 const LandingPipelineOptions& options)
    : impl_(std::make_unique<Impl>(std::span(&calibration, 1), ListOf(std::move(detector)),
                                   options)) {}
LandingPipeline::LandingPipeline(std::span<const CameraCalibration> cameras,
                                 const LandingPipelineOptions& options)
    : LandingPipeline(cameras, {}, options) {}
LandingPipeline::LandingPipeline(std::span<const CameraCalibration> cameras,
                                 std::vector<std::unique_ptr<const TargetDetector>> detectors,
                                 const LandingPipelineOptions& options)
    : impl_(std::make_unique<Impl>(cameras, std::move(detectors), options)) {}
LandingPipeline::~LandingPipeline() = default;
LandingPipeline::LandingPipeline(LandingPipeline&&) noexcept = default;
LandingPipeline& LandingPipeline::operator=(LandingPipeline&&) noexcept = default;

PoseStatus LandingPipeline::AddPose(const PoseSample& sample) { return impl_->AddPose(sample); }
PoseStatus LandingPipeline::AddGimbal(const GimbalSample& sample) {
  return impl_->AddGimbal(sample);
}
PoseStatus LandingPipeline::AddZoom(const ZoomSample& sample) { return impl_->AddZoom(sample); }
void LandingPipeline::SetAltitude(std::optional<double> altitude_m) {
  impl_->SetAltitude(altitude_m);
}
void LandingPipeline::LimitSearch(double max_search_ms) { impl_->LimitSearch(max_search_ms); }
void LandingPipeline::ChangeOptions(const LandingPipelineOptions& options) {
  impl_->ChangeOptions(options);
}
LandingObservation LandingPipeline::Process(const cv::Mat& image, Time time, std::size_t camera) {
  return impl_->Process(image, time, camera);
}
std::size_t LandingPipeline::camera_count() const { return impl_->camera_count(); }
const CameraState& LandingPipeline::camera_state(std::size_t camera) const {
  return impl_->camera_state(camera);
}
const InputContradictions& LandingPipeline::contradictions(std::size_t camera) const {
  return impl_->contradictions(camera);
}
const CalibrationMonitor& LandingPipeline::calibration_monitor(std::size_t camera) const {
  return impl_->calibration_monitor(camera);
}
const TargetTracker& LandingPipeline::tracker() const { return impl_->tracker(); }
const TargetDetector& LandingPipeline::detector(std::size_t camera) const {
  return impl_->detector(camera);
}
const LandingPipelineOptions& LandingPipeline::options() const { return impl_->options(); }

}  // namespace kestrel
