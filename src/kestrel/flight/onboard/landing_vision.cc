// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/landing_vision.h"

#include <cmath>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/tables/landing_csv.h"
#include "kestrel/io/recording/tables/track_csv.h"
#include "kestrel/vision/pipeline/calibration_monitor.h"
#include "kestrel/vision/pipeline/measurement_noise.h"
#include "kestrel/vision/pipeline/pattern_area.h"

namespace kestrel {
namespace {

constexpr char kDetections[] = "landing_detections.csv";
constexpr char kTrack[] = "landing_track.csv";
constexpr std::size_t kResults = 256;  // that may wait for the disk

std::optional<RigidTransform> InverseOf(const std::optional<RigidTransform>& transform) {
  if (!transform) return std::nullopt;
  return transform->Inverse();
}

}  // namespace

LandingVision::LandingVision(const CameraCalibration& calibration,
                             const LandingPipelineOptions& options, const OutputFolder* output,
                             bool has_track, const std::optional<ExposureDrive>& exposure)
    : pipeline_(calibration, options),
      camera_from_body_(InverseOf(calibration.body_from_camera)),
      clock_offset_(calibration.clock_offset.value_or(Duration::zero())),
      results_(kResults),
      exposure_(exposure) {
  if (output == nullptr) return;
  detections_ = output->OpenText(kDetections);
  WriteAtOnce(LandingCsvHeader(), kDetections, &*detections_);
  if (!has_track) return;
  track_ = output->OpenText(kTrack);
  WriteAtOnce(TrackCsvHeader(), kTrack, &*track_);
}

TrackSnapshot LandingVision::Process(const Frame& frame, ObservationSink* sink) {
  LimitSearch(frame);
  const LandingObservation observation = pipeline_.Process(frame.image, frame.time);
  snapshot_.captured = frame.time + clock_offset_;
  snapshot_.state = observation.track_state;
  snapshot_.target = observation.target;
  if (observation.fate == MeasurementFate::kStarted ||
      observation.fate == MeasurementFate::kAccepted) {
    snapshot_.seen = snapshot_.captured;
  }
  snapshot_.sighting = Sighting(observation);
  if (observation.report.detection && camera_from_body_) {
    const RigidTransform& camera_from_target = observation.report.detection->camera_from_pattern;
    snapshot_.sight = {snapshot_.captured, camera_from_target.Inverse() * *camera_from_body_};
  }
  snapshot_.detect_time = observation.detect_time;
  ++snapshot_.frames;
  if (observation.report.detection) ++snapshot_.detections;
  snapshot_.other_tag = observation.other_tag;
  if (exposure_) ControlExposure(frame.image, observation);
  if (detections_) results_.Push({frame.name, observation});
  if (sink != nullptr && sink->IsWanted()) {
    sink->Take(Observation{frame, observation, Now() - frame.time});
  }
  return snapshot_;
}

// A search that takes longer than the camera's period costs a frame; a search that is given up goes
// on in the next frame. The rest of the period is left for the step that is running, and for the
// other work of a frame.
void LandingVision::LimitSearch(const Frame& frame) {
  constexpr double kSearchShare = 0.6;
  period_.Add(frame.time);
  if (const auto period = period_.Get()) {
    pipeline_.LimitSearch(kSearchShare * 1e3 * ToSeconds(*period));
  }
}

std::optional<TargetReport> LandingVision::Sighting(const LandingObservation& observation) const {
  const auto& detection = observation.report.detection;
  if (!detection || !observation.world_from_camera || !camera_from_body_) return std::nullopt;
  const RigidTransform& world_from_camera = *observation.world_from_camera;
  const Eigen::Vector3d& center = detection->camera_from_pattern.translation;
  // Relative to the UAV only the pose's attitude counts, including the errors that all frames
  // share.
  MeasurementNoise noise = pipeline_.options().noise;
  noise.pose_sigma_m = noise.pose_bias_m = 0;
  TargetReport report;
  report.time = snapshot_.captured;
  report.world_from_body = world_from_camera * *camera_from_body_;
  report.position_in_world = world_from_camera * center;
  report.normal_in_world = world_from_camera.rotation *
                           (detection->camera_from_pattern.rotation * Eigen::Vector3d::UnitZ());
  report.covariance = CovarianceInWorld(detection->covariance.topLeftCorner<3, 3>(), center,
                                        world_from_camera.rotation, noise) +
                      SharedCovarianceInWorld(center, world_from_camera.rotation, noise);
  if (detection->heading_symmetry != 1) return report;
  report.yaw = observation.yaw_in_world;
  report.yaw_sigma = std::sqrt(YawVarianceInWorld(detection->covariance.bottomRightCorner<3, 3>(),
                                                  world_from_camera.rotation, noise));
  return report;
}

void LandingVision::ControlExposure(const cv::Mat& image, const LandingObservation& observation) {
  const TargetDetector& detector = pipeline_.detector();
  const auto& detection = observation.report.detection;
  exposure_->Update(
      image, detection ? PatternArea(*detection, detector.shape(), detector.camera()) : cv::Rect());
}

std::string LandingVision::Warning() const {
  return LensWarning(pipeline_.calibration_monitor(),
                     pipeline_.detector().camera().intrinsics().fx_px);
}

bool LandingVision::WriteResults() {
  try {
    while (const auto result = results_.TryPop()) {
      WriteAtOnce(LandingCsvRow(result->frame_name, result->observation), kDetections,
                  &*detections_);
      has_track_begun_ = has_track_begun_ || result->observation.fate;
      if (track_ && has_track_begun_)
        WriteAtOnce(TrackCsvRow(result->observation), kTrack, &*track_);
    }
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::string LandingVision::Found() const {
  const auto& other = snapshot_.other_tag;
  return fmt::format("pattern found in {}{}", snapshot_.detections,
                     other ? fmt::format(" ({})", InWords(*other)) : "");
}

}  // namespace kestrel
