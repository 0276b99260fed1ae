// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/touchdown_simulation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "kestrel/core/base/limits.h"
#include "kestrel/simulation/recordings/truth_text.h"
#include "kestrel/simulation/vehicle/flight_time.h"
#include "kestrel/vision/pipeline/pattern_area.h"
#include "kestrel/vision/targets/make_target_detector.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFlightStep_s = 0.005;
constexpr double kRideOn_s = 1;    // after touchdown, for the last poses of the navigation
constexpr int kExposureDelay = 2;  // number of images with the old exposure after a change

CameraCalibration WithClockOffset(CameraCalibration camera, Duration clock_offset) {
  camera.clock_offset = clock_offset;
  return camera;
}

LandingPipelineOptions PipelineOptions(const TouchdownSimulationOptions& simulation) {
  LandingPipelineOptions options;
  options.target = simulation.target;
  options.detector.pattern = simulation.pattern;
  options.tracker = simulation.tracker;
  return options;
}

}  // namespace

std::vector<std::string> TouchdownOptions::Validate() const {
  std::vector<std::string> violations;
  Require(pass_max_s, Range{pass_min_s, 1000}, "pass_max_s", &violations);
  return violations;
}

TouchdownSimulationOptions::TouchdownSimulationOptions() {
  constexpr double kLongestFlight_s = 90;
  recording.rate_hz = 20;
  recording.frames = static_cast<int>(kLongestFlight_s * recording.rate_hz);
  recording.shutter.rays_per_pixel = 4;
  recording.navigation.mount_error_deg = 0;
  recording.navigation.clock_offset_min_s = 0;
  recording.navigation.clock_offset_max_s = 0;
  // The abilities of the multicopter, and more room than the vehicle needs.
  guidance.limits = {.geofence_radius_m = 300,
                     .max_speed_mps = multicopter.max_speed_mps,
                     .max_climb_mps = 2.5,
                     .max_sink_mps = 2.5,
                     .max_tilt_deg = multicopter.max_tilt_deg};
}

// A simulated gimbal needs to know the whole flight, which this loop decides as it goes; and there
// are no reports of a zoom in it.
std::vector<std::string> TouchdownSimulationOptions::Validate() const {
  std::vector<std::string> violations;
  if (recording.gimbal.is_there()) {
    violations.emplace_back(
        "gimbal.rate_hz is more than 0, expected 0: the camera of a touchdown is fixed");
  }
  RequireFixedLens(recording.zoom, &violations);
  return violations;
}

TouchdownSimulation::TouchdownSimulation(const TouchdownSimulationOptions& options,
                                         const CameraCalibration& camera, std::uint64_t seed)
    : options_(Checked(options)),
      seed_(seed),
      path_(0, kFlightStep_s),
      landing_(
          options.recording, options.surroundings, camera,
          MakeLandingScene(options, options.recording.duration_s(), /*channels=*/1, seed),
          [this](double time_s) { return path_.At(time_s); }, seed),
      start_(DrawStart()),
      multicopter_(options.multicopter, start_.position, start_.heading, start_.velocity),
      navigation_(landing_.flight().navigation()),
      clock_offset_(DurationFromSeconds(landing_.flight().errors().clock_offset_s)),
      pipeline_(WithClockOffset(camera, clock_offset_), PipelineOptions(options)),
      guidance_(
          options.guidance.WithinSight(pipeline_.detector().shape().SightRange(camera.intrinsics)),
          start_.place),
      exposure_(options.exposure, options.recording.shutter.exposure_s),
      exposures_s_(kExposureDelay + 1, exposure_.exposure_s()) {
  Random random = RandomOf(seed, LandingPart::kWind);
  wind_ = MakeWind(options.wind, &random);
}

TouchdownSimulation::Start TouchdownSimulation::StartBehind() const {
  const RigidTransform vehicle = landing_.world_from_pattern()(0);
  Start start;
  start.velocity = VelocityOf(landing_.world_from_pattern(), 0);
  start.velocity.z() = 0;
  start.heading = std::atan2(start.velocity.y(), start.velocity.x());
  start.place = vehicle.translation.head<2>();
  const Vector2d along(std::cos(start.heading), std::sin(start.heading));
  start.position << start.place - options_.touchdown.start_distance_m * along,
      options_.touchdown.start_altitude_m;
  return start;
}

TouchdownSimulation::Start TouchdownSimulation::DrawStart() const {
  const TouchdownOptions& options = options_.touchdown;
  if (options.starts_behind) return StartBehind();
  Random random = RandomOf(seed_, LandingPart::kStart);
  const double pass_s = random.Uniform(options.pass_min_s, options.pass_max_s);
  const Vector2d place = landing_.world_from_pattern()(pass_s).translation.head<2>();
  const Vector2d vehicle = landing_.world_from_pattern()(0).translation.head<2>();
  // Not at a place from which it would see the vehicle at once.
  constexpr int kTries = 20;
  Vector2d away(1, 0);
  for (int i = 0; i < kTries; ++i) {
    const double direction = random.Uniform(0, 2 * std::numbers::pi);
    away << std::cos(direction), std::sin(direction);
    const Vector2d start = place + options.start_distance_m * away;
    if ((start - vehicle).norm() >= options.start_distance_m) break;
  }
  Start start;
  start.place = place;
  start.position << place + options.start_distance_m * away, options.start_altitude_m;
  start.heading = std::atan2(-away.y(), -away.x());
  return start;
}

std::optional<TouchdownResult> TouchdownSimulation::Fly(const FrameSink& sink) {
  TouchdownResult result;
  double wind_mps = 0;
  int step = 0;
  for (;; ++step) {
    const double time_s = step * kFlightStep_s;
    path_.Add(multicopter_.world_from_body());
    ReportPoses(time_s);
    TakeImage(time_s);
    if (!ProcessImages(time_s - options_.touchdown.processing_delay_s, sink, &result)) {
      return std::nullopt;
    }
    if (HasEnded(time_s, &result)) break;
    const Vector3d wind = wind_(time_s);
    wind_mps += wind.norm();
    multicopter_.Step(Guide(time_s), wind, kFlightStep_s);
  }
  RideOn(result.time_s);
  ReportPoses(path_.end_s());
  if (!ProcessImages(path_.end_s(), sink, &result)) return std::nullopt;
  landing_.EndBefore(next_image_);
  result.wind_mps = wind_mps / std::max(step, 1);
  result.go_arounds = guidance_.go_arounds();
  result.frames = static_cast<int>(next_image_);
  return result;
}

// Adds the navigation's reports up to now.
void TouchdownSimulation::ReportPoses(double time_s) {
  for (;; ++poses_) {
    const double pose_s =
        landing_.flight().begin_s() + poses_ / options_.recording.navigation.rate_hz;
    if (pose_s > time_s) return;
    newest_pose_ = navigation_.Report(pose_s, path_.At(pose_s));
    pipeline_.AddPose(newest_pose_);
  }
}

// Takes the next image, if its exposure has ended.
void TouchdownSimulation::TakeImage(double time_s) {
  const std::vector<double>& times_s = landing_.flight().times_s();
  if (next_image_ == times_s.size()) return;
  const ShutterOptions& shutter = options_.recording.shutter;
  const double image_s = times_s[next_image_];
  if (time_s < image_s + 0.5 * (shutter.exposure_s + shutter.readout_s)) return;
  const cv::Mat image =
      landing_.flight().Image(next_image_, exposures_s_.front() / shutter.exposure_s);
  exposures_s_.pop_front();
  exposures_s_.push_back(exposure_.Update(image, pattern_area_));
  images_.push_back({image, TimeOfFlight(image_s)});
  ++next_image_;
}

// Processes the images taken up to 'until_s'.
bool TouchdownSimulation::ProcessImages(double until_s, const FrameSink& sink,
                                        TouchdownResult* result) {
  for (; !images_.empty() && images_.front().time <= TimeOfFlight(until_s); images_.pop_front()) {
    const auto& [image, time] = images_.front();
    const LandingObservation observation = pipeline_.Process(image, time);
    const double image_s = ToSeconds(time - kStartTime);
    const auto& detection = observation.report.detection;
    pattern_area_ = {};
    if (detection) {
      last_seen_ = time;
      pattern_area_ =
          PatternArea(*detection, pipeline_.detector().shape(), pipeline_.detector().camera());
      if (!result->first_seen_s) result->first_seen_s = image_s;
    }
    TouchdownMoment moment{time, guidance_.phase(), FeetAt(image_s),
                           landing_.world_from_pattern()(image_s).translation, std::nullopt};
    if (observation.target) moment.target_in_world = observation.target->motion.position();
    result->path.push_back(moment);
    if (!sink(image, observation, pipeline_)) return false;
  }
  return true;
}

// The pilot gives the mode at once, and the link is perfect.
SetPoint TouchdownSimulation::Guide(double time_s) {
  GuidanceInput input;
  input.now = TimeOfFlight(time_s);
  input.is_armed = true;
  input.is_guided = time_s > 0;
  UavState uav;
  uav.velocity_in_world = multicopter_.velocity();
  const Duration age = input.now + clock_offset_ - newest_pose_.time;
  uav.world_from_body = newest_pose_.world_from_body;
  uav.world_from_body.translation += ToSeconds(age) * uav.velocity_in_world;
  input.uav = uav;
  const TargetTracker& tracker = pipeline_.tracker();
  if (tracker.StateAt(input.now) != TrackState::kSearching) {
    input.target = tracker.Predict(input.now);
  }
  if (last_seen_) input.target_age_s = ToSeconds(input.now - *last_seen_);
  return guidance_.Update(input).set_point.value_or(SetPoint());
}

bool TouchdownSimulation::HasEnded(double time_s, TouchdownResult* result) const {
  result->time_s = time_s;
  if (next_image_ == landing_.flight().times_s().size()) return true;
  const Vector3d feet_on_board = landing_.world_from_pattern()(time_s).Inverse() * FeetAt(time_s);
  if (feet_on_board.z() > 0) return false;
  const Vector3d slip = multicopter_.velocity() - VelocityOf(landing_.world_from_pattern(), time_s);
  result->distance_m = feet_on_board.head<2>().norm();
  result->slip_mps = slip.head<2>().norm();
  result->sink_mps = -slip.z();
  result->heading_error = HeadingError(time_s);
  result->outcome = OutcomeOf(feet_on_board, *result);
  return true;
}

// Returns the angle of the nose off the wanted heading, rad; nothing where any heading will do.
std::optional<double> TouchdownSimulation::HeadingError(double time_s) const {
  const auto wanted = options_.guidance.HeadingOverPad();
  if (!wanted) return std::nullopt;
  const double over_pad = LevelHeadingOf(path_.At(time_s).rotation) -
                          LevelHeadingOf(landing_.world_from_pattern()(time_s).rotation);
  const int symmetry = HeadingSymmetryOf(options_.target.kind).value();
  return std::remainder(over_pad - *wanted, 2 * std::numbers::pi / symmetry);
}

TouchdownOutcome TouchdownSimulation::OutcomeOf(const Vector3d& feet_on_board,
                                                const TouchdownResult& result) const {
  const TouchdownOptions& options = options_.touchdown;
  const double to_side_m = ReachOnBoard(landing_.print(), feet_on_board.head<2>());
  const double deck_m = std::max(landing_.print().board_size_m, options.deck_m);
  if (to_side_m > 0.5 * deck_m - options.feet_radius_m) {
    return TouchdownOutcome::kBesideBoard;
  }
  const bool is_slow =
      result.slip_mps <= options.max_slip_mps && result.sink_mps <= options.max_sink_mps;
  return is_slow ? TouchdownOutcome::kLanded : TouchdownOutcome::kTooFast;
}

// The vehicle carries the UAV for a moment.
void TouchdownSimulation::RideOn(double time_s) {
  const RigidTransform pattern_from_body =
      landing_.world_from_pattern()(time_s).Inverse() * path_.At(time_s);
  while (path_.end_s() < time_s + kRideOn_s) {
    path_.Add(landing_.world_from_pattern()(path_.end_s() + kFlightStep_s) * pattern_from_body);
  }
}

Vector3d TouchdownSimulation::FeetAt(double time_s) const {
  return path_.At(time_s) * Vector3d(0, 0, -options_.touchdown.leg_m);
}

}  // namespace kestrel
