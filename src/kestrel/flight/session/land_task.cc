// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/land_task.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/flight/session/frame_period.h"
#include "kestrel/flight/session/landing_files.h"
#include "kestrel/flight/session/task.h"
#include "kestrel/io/recording/overlays/landing_overlay.h"
#include "kestrel/vision/pipeline/calibration_monitor.h"
#include "kestrel/vision/pipeline/input_contradictions.h"
#include "kestrel/vision/pipeline/measurement_noise.h"
#include "kestrel/vision/pipeline/pattern_area.h"
#include "kestrel/vision/pipeline/require_altitude.h"

namespace kestrel {
namespace {

std::string AttitudeWarning(const Contradiction& tilt) {
  return fmt::format(
      "the attitude says that the pattern is tilted by {:.0f} degrees (median of {} frames): {}"
      "check the mount (kestrel calibrate mount) and the navigation's attitude",
      Degrees(tilt.difference), tilt.detections,
      tilt.difference > kPi / 2 ? "is the camera mounted upside down? " : "");
}

std::vector<CameraCalibration> CamerasOf(const SessionCamera& camera) {
  std::vector<CameraCalibration> all = {camera.calibration};
  all.insert(all.end(), camera.further.begin(), camera.further.end());
  return all;
}

Duration ClockOffset(const CameraCalibration& camera) {
  return camera.clock_offset.value_or(Duration::zero());
}

// The landing pipeline in a session.
class LandingVision : public Vision {
 public:
  // 'predict_s': horizons of the predictions that are written. Throws InputError when camera or
  // options are not valid.
  LandingVision(const SessionCamera& camera, const LandingPipelineOptions& options,
                std::vector<double> predict_s = {});

  void AddPose(const PoseSample& pose) override { pipeline_.AddPose(pose); }
  void AddGimbal(const GimbalSample& sample) override { pipeline_.AddGimbal(sample); }
  void AddZoom(const ZoomSample& sample) override { pipeline_.AddZoom(sample); }
  Duration pose_lead() const override { return pose_lead_; }
  Observation Process(const Frame& frame) override;
  TrackSnapshot snapshot() const override { return snapshot_; }
  std::optional<PadInSight> pad() const override;
  bool has_world() const override { return has_world_ && !pipeline_.options().still; }
  void Change(const TaskOptions& options, std::optional<double> altitude_m) override;
  std::unique_ptr<ObservationSink> MakeTables(const OutputOptions& output) const override;
  ObservationPainter MakePainter() const override;

  // Reports how the detections contradict the given height and attitude; in flight, the lens.
  std::string Warning() const override;
  std::span<const std::string> camera_events() const override { return faults_; }
  std::string Found() const override;
  // Contradictions between detections and calibration; the number of frames without a pose, where
  // others have one.
  std::string Remarks() const override;

 private:
  // One of the cameras.
  struct Camera {
    explicit Camera(std::string camera_name) : name(std::move(camera_name)) {}

    std::string name;  // empty where it is the only one
    FramePeriod period;
    int frames = 0;
    int detections = 0;
    CameraHealth health = CameraHealth::kGood;
  };

  void Watch(const LandingObservation& observation);
  void WatchGimbal(PoseLookup pose);
  void AddFault(std::string fault);
  std::string OfCamera(std::size_t camera, const std::string& text) const;
  std::string WarningOf(std::size_t camera) const;
  void LimitSearch(const Frame& frame);
  bool IsUsed(const LandingObservation& observation) const;
  void UpdateSnapshot(const LandingObservation& observation);
  std::optional<TargetState> Sighting(const LandingObservation& observation) const;
  std::string LensWarning() const;

  LandingPipeline pipeline_;
  Duration clock_offset_;  // the first camera's
  Duration pose_lead_;
  std::optional<double> altitude_m_;
  bool has_world_, is_lens_unknown_, is_live_;
  std::vector<double> predict_s_;
  std::vector<Camera> cameras_;
  std::optional<Time> begin_;        // time of the first frame
  std::vector<std::string> faults_;  // what is wrong with each camera, in words
  TrackSnapshot snapshot_;
  std::map<PoseLookup, std::size_t> poses_;
  std::size_t zooming_ = 0;  // frames that were not searched therefore
};

LandingVision::LandingVision(const SessionCamera& camera, const LandingPipelineOptions& options,
                             std::vector<double> predict_s)
    : pipeline_(CamerasOf(camera), InFlight(options, camera.is_live)),
      clock_offset_(ClockOffset(camera.calibration)),
      pose_lead_(clock_offset_),
      altitude_m_(camera.altitude_m),
      has_world_(camera.has_world),
      is_lens_unknown_(camera.is_lens_unknown),
      is_live_(camera.is_live),
      predict_s_(std::move(predict_s)) {
  RequireAltitude(altitude_m_);
  pipeline_.SetAltitude(altitude_m_);
  for (const CameraCalibration& further : camera.further) {
    pose_lead_ = std::max(pose_lead_, ClockOffset(further));
  }
  for (const CameraCalibration& each : CamerasOf(camera)) cameras_.emplace_back(each.name);
}

Observation LandingVision::Process(const Frame& frame) {
  if (is_live_) LimitSearch(frame);
  LandingObservation seen = pipeline_.Process(frame.image, frame.time, frame.camera);
  if (cameras_.size() > 1) Watch(seen);
  ++poses_[seen.pose];
  WatchGimbal(seen.pose);
  zooming_ += seen.is_zooming;
  ++snapshot_.frames;
  snapshot_.detections += seen.report.detection.has_value();
  snapshot_.other_tag = seen.other_tag;
  if (is_live_ && IsUsed(seen)) UpdateSnapshot(seen);
  return {frame, std::move(seen)};
}

// A search that takes longer than the camera's period costs a frame; a search that is given up goes
// on in the next frame. The rest of the period is left for the step that is running, and for the
// other work of a frame.
void LandingVision::LimitSearch(const Frame& frame) {
  constexpr double kSearchShare = 0.6;
  FramePeriod& camera = cameras_[frame.camera].period;
  camera.Add(frame.time);
  if (const auto period = camera.Get()) {
    const double share = kSearchShare / static_cast<double>(cameras_.size());
    pipeline_.LimitSearch(share * 1e3 * ToSeconds(*period));
  }
}

// False for a frame of a camera that is left out: guidance must not follow what that one sees.
bool LandingVision::IsUsed(const LandingObservation& observation) const {
  if (cameras_.size() == 1) return true;
  if (observation.center_in_world) return observation.fate.has_value();
  return pipeline_.camera_state(observation.camera).is_used();
}

void LandingVision::UpdateSnapshot(const LandingObservation& observation) {
  snapshot_.captured = observation.time + clock_offset_;
  snapshot_.state = observation.track_state;
  snapshot_.target = observation.target;
  if (observation.fate == MeasurementFate::kStarted ||
      observation.fate == MeasurementFate::kAccepted) {
    snapshot_.seen = snapshot_.captured;
  }
  snapshot_.sighting = Sighting(observation);
  snapshot_.detect_time = observation.detect_time;
  snapshot_.area = {};
  const auto& detection = observation.report.detection;
  if (!detection) return;
  const TargetDetector& detector = pipeline_.detector(observation.camera);
  snapshot_.area = PatternArea(*detection, detector.shape(), detector.camera());
  if (!observation.camera_from_body) return;
  snapshot_.sight = SightOf(*detection, *observation.camera_from_body, snapshot_.captured);
}

std::optional<TargetState> LandingVision::Sighting(const LandingObservation& observation) const {
  const auto& detection = observation.report.detection;
  if (!detection || !observation.world_from_camera || !observation.camera_from_body) {
    return std::nullopt;
  }
  const RigidTransform& world_from_camera = *observation.world_from_camera;
  const Eigen::Vector3d& center = detection->camera_from_target.translation;
  // Relative to the UAV only the pose's attitude counts, including the errors that all frames
  // share.
  MeasurementNoise noise = pipeline_.options().noise;
  noise.pose_sigma_m = noise.pose_bias_m = 0;
  TargetState report;
  report.time = snapshot_.captured;
  report.world_from_body = world_from_camera * *observation.camera_from_body;
  report.position_in_world = world_from_camera * center;
  report.normal_in_world = world_from_camera.rotation *
                           (detection->camera_from_target.rotation * Eigen::Vector3d::UnitZ());
  report.covariance = CovarianceInWorld(detection->covariance.topLeftCorner<3, 3>(), center,
                                        world_from_camera.rotation, noise) +
                      SharedCovarianceInWorld(center, world_from_camera.rotation, noise);
  if (detection->heading_symmetry != 1) return report;
  report.yaw = observation.yaw_in_world;
  report.yaw_sigma = std::sqrt(YawVarianceInWorld(detection->covariance.bottomRightCorner<3, 3>(),
                                                  world_from_camera.rotation, noise));
  return report;
}

std::optional<PadInSight> LandingVision::pad() const {
  const TargetShape& shape = pipeline_.detector().shape();
  double range_m = 0;
  for (std::size_t i = 0; i < pipeline_.camera_count(); ++i) {
    const CameraModel& camera = pipeline_.detector(i).camera();
    range_m = std::max(range_m, shape.SightRange(camera.intrinsics()));
  }
  return PadInSight{shape.diameter_m, range_m, pipeline_.options().tracker};
}

void LandingVision::Change(const TaskOptions& options, std::optional<double> altitude_m) {
  pipeline_.ChangeOptions(InFlight(options.landing, is_live_));
  pipeline_.SetAltitude(altitude_m);
  altitude_m_ = altitude_m;
}

std::unique_ptr<ObservationSink> LandingVision::MakeTables(const OutputOptions& output) const {
  // In flight they are written by another thread, which must not read the tracker.
  const std::vector<double> horizons_s = is_live_ ? std::vector<double>() : predict_s_;
  std::vector<std::string> further;
  for (std::size_t i = 1; i < cameras_.size(); ++i) further.push_back(cameras_[i].name);
  return std::make_unique<LandingFiles>(output, &pipeline_, has_world(), horizons_s, further);
}

ObservationPainter LandingVision::MakePainter() const {
  const TargetDetector& detector = pipeline_.detector(0);
  return [camera = detector.camera(), shape = detector.shape()](const Observation& observation) {
    const Frame& frame = observation.frame;
    const auto& seen = std::get<LandingObservation>(observation.seen);
    return DrawLandingOverlay(frame.color.empty() ? frame.image : frame.color,
                              seen.zoomed_lens ? *seen.zoomed_lens : camera, shape, seen);
  };
}

std::string LandingVision::Warning() const {
  if (is_live_) return LensWarning();
  if (!faults_.empty()) return faults_.front();
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (const std::string warning = WarningOf(i); !warning.empty()) return OfCamera(i, warning);
  }
  return "";
}

std::string LandingVision::WarningOf(std::size_t camera) const {
  const InputContradictions& contradictions = pipeline_.contradictions(camera);
  if (const auto tilt = contradictions.Attitude()) return AttitudeWarning(*tilt);
  const auto excess = contradictions.Altitude();
  if (!excess) return "";
  const std::string what = fmt::format(
      "the given altitude is {:.1f} m {} the one that the pattern shows (median of {} frames, "
      "standard deviation {:.1f} m): ",
      std::abs(excess->difference), excess->difference > 0 ? "above" : "below", excess->detections,
      excess->sigma);
  if (has_world_) {
    return fmt::format(
        "{}set landing.target_height_m={:.1f}, or correct the navigation's z or the pattern's size",
        what, pipeline_.options().target_height_m + excess->difference);
  }
  return fmt::format("{}set --altitude {:.1f}, or correct the pattern's size", what,
                     altitude_m_.value_or(0) - excess->difference);
}

std::string LandingVision::LensWarning() const {
  std::string warnings;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    const std::string warning = kestrel::LensWarning(
        pipeline_.calibration_monitor(i), pipeline_.detector(i).camera().intrinsics().fx_px);
    if (warning.empty()) continue;
    if (!warnings.empty()) warnings += "\n";
    warnings += OfCamera(i, warning);
  }
  return warnings;
}

// Notes what happens to the cameras.
void LandingVision::Watch(const LandingObservation& observation) {
  if (!begin_) begin_ = observation.time;
  Camera& own = cameras_[observation.camera];
  ++own.frames;
  own.detections += observation.report.detection.has_value();
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    const CameraState& state = pipeline_.camera_state(i);
    if (state.health == std::exchange(cameras_[i].health, state.health)) continue;
    AddFault(fmt::format("at {:.2f} s {} {}", ToSeconds(state.since - *begin_), cameras_[i].name,
                         InWords(state)));
  }
}

// Notes once in flight that the gimbal has been silent from the beginning.
void LandingVision::WatchGimbal(PoseLookup pose) {
  constexpr std::size_t kMany = 40;
  if (!is_live_ || pose != PoseLookup::kNoGimbal || poses_[pose] != kMany) return;
  if (poses_.contains(PoseLookup::kFound) || poses_.contains(PoseLookup::kPredicted)) return;
  AddFault(
      "no report of the gimbal, so that no frame has a place: is gimbal.device_id in the camera's "
      "file right? (kestrel doctor)");
}

void LandingVision::AddFault(std::string fault) {
  constexpr std::size_t kMost = 20;  // a camera that comes and goes does not fill the memory
  if (faults_.size() < kMost) faults_.push_back(std::move(fault));
}

std::string LandingVision::OfCamera(std::size_t camera, const std::string& text) const {
  return cameras_.size() == 1 ? text : fmt::format("{}: {}", cameras_[camera].name, text);
}

std::string LandingVision::Found() const {
  const auto& other = snapshot_.other_tag;
  std::string found = fmt::format("pattern found in {}{}", snapshot_.detections,
                                  other ? fmt::format(" ({})", InWords(*other)) : "");
  if (cameras_.size() == 1) return found;
  for (const Camera& camera : cameras_) {
    found += fmt::format(", {} {} of {}", camera.name, camera.detections, camera.frames);
  }
  return found;
}

std::string LandingVision::Remarks() const {
  std::string remarks;
  if (!is_lens_unknown_) remarks = LensWarning();
  if (!remarks.empty()) remarks += "\n";
  for (const std::string& fault : faults_) remarks += fault + "\n";
  if (zooming_ > 0) {
    remarks += fmt::format(
        "{} frames left out: the lens zoomed, or no report of its view held (docs/mounts.md)\n",
        zooming_);
  }
  // Only where there are poses for some of the frames; a source without any is not unusual.
  for (const auto& [pose, count] : poses_) {
    if (pose == PoseLookup::kFound || pose == PoseLookup::kEmpty ||
        pose == PoseLookup::kPredicted) {
      continue;
    }
    remarks += fmt::format("{} frames without a pose of the UAV: {}\n", count, ToString(pose));
  }
  return remarks;
}

}  // namespace

std::unique_ptr<Vision> LandTask::MakeVision(const SessionCamera& camera) const {
  return std::make_unique<LandingVision>(camera, options_, predict_s_);
}

}  // namespace kestrel
