// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/pointed_gimbal.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/flight/onboard/target_sender.h"

namespace kestrel {
namespace {

using Control = GimbalManager::Control;
using Eigen::Vector3d;

constexpr double kRate_hz = 20;
// Time constant of a common gimbal. Half as much or twice as much costs a degree or two where the
// target passes at 20 deg/s.
constexpr double kGimbalLag_s = 0.1;
// A set-point is held until the next one.
constexpr double kHeld_s = 0.5 / kRate_hz;

double AngleBetween(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

GimbalView GimbalViewOf(const CameraCalibration& calibration, const PadInSight& pad) {
  const CameraIntrinsics& lens = calibration.intrinsics;
  const CameraModel camera(lens);
  const double right = lens.width_px - 1, bottom = lens.height_px - 1;
  double half_angle = kPi / 2;
  for (const Eigen::Vector2d& rim : {Eigen::Vector2d(0, lens.cy_px),
                                     {right, lens.cy_px},
                                     {lens.cx_px, 0},
                                     {lens.cx_px, bottom}}) {
    Vector3d ray;
    if (camera.Unproject(rim, &ray) != ProjectionStatus::kOk) continue;
    half_angle = std::min(half_angle, AngleBetween(ray, Vector3d::UnitZ()));
  }
  const Vector3d axis = calibration.gimbal->platform_from_camera.rotation * Vector3d::UnitZ();
  return {.axis_pitch = std::atan2(-axis.z(), axis.x()),
          .half_angle = half_angle,
          .pad_size_m = pad.size_m,
          .sight_range_m = pad.range_m};
}

PointedGimbal::PointedGimbal(const FlightOptions& options, const CameraCalibration& calibration,
                             const std::optional<PadInSight>& pad,
                             const TargetTrackerOptions& tracker, Autopilot* autopilot,
                             Connection* connection, std::function<void(const std::string&)> report)
    : options_(options),
      has_pad_(pad.has_value()),
      body_from_pivot_(calibration.gimbal->body_from_pivot),
      noise_(tracker.Noise()),
      autopilot_(*autopilot),
      report_(std::move(report)),
      manager_(calibration.gimbal->device_id, autopilot, connection),
      pointing_(GimbalViewOf(calibration, pad.value_or(PadInSight()))),
      schedule_(kRate_hz) {}

void PointedGimbal::Point(Time now, const TrackSnapshot& track, const PoseHistory& poses) {
  WatchFlight(track.mark);
  manager_.Tick(now);
  ReportControl(now);
  if (!IsFlying() || !schedule_.IsDue(now, false)) return;
  const Duration ahead =
      LinkDelay(options_, autopilot_) + DurationFromSeconds(kGimbalLag_s + kHeld_s);
  constexpr Duration kMaxPoseAge = std::chrono::milliseconds(300);
  const auto pose = poses.Predict(now + ahead, ahead + kMaxPoseAge, {});
  if (!pose) return;
  if (manager_.range()) pointing_.set_range(*manager_.range());
  const auto target = Target(now + ahead, track);
  if (!has_pad_ && !target) return;
  const RigidTransform world_from_pivot = pose->world_from_body * body_from_pivot_;
  const GimbalAngles aim = pointing_.Update({now, world_from_pivot, target});
  manager_.Send(aim);
  WatchFollowing(now, aim, HeadingOf(world_from_pivot.rotation));
}

void PointedGimbal::Resume() {
  if (manager_.control() == Control::kTaken) manager_.TakeControl();
}

// Control is requested when the UAV flies and there is something to point at, and again when the
// pilot gives the guided mode, or something else is marked.
void PointedGimbal::WatchFlight(int mark) {
  const bool is_guided = autopilot_.is_here() ? autopilot_.is_guided_mode() : was_guided_;
  const bool is_given = is_guided && !std::exchange(was_guided_, is_guided);
  const bool is_marked = mark != std::exchange(mark_, mark);
  const Control control = manager_.control();
  const bool begins = control == Control::kNone && IsFlying() && (has_pad_ || mark > 0);
  const bool resumes = control == Control::kTaken && (is_given || is_marked);
  if (begins || resumes) manager_.TakeControl();
}

bool PointedGimbal::IsFlying() const {
  return autopilot_.is_here() && autopilot_.is_armed() && IsInFlight(autopilot_.landed_state());
}

void PointedGimbal::ReportControl(Time now) {
  constexpr double kPatience_s = 5;
  const Control control = manager_.control();
  if (control == Control::kRequested && requested_ && ToSeconds(now - *requested_) > kPatience_s) {
    requested_ = now + std::chrono::hours(1);
    Notify(mavlink::kSeverityWarning,
           "the autopilot gives no control of the gimbal: has it one (MNT1_TYPE of ArduPilot, "
           "MNT_MODE_IN 4 of PX4)?");
  }
  if (control == reported_) return;
  reported_ = control;
  if (control == Control::kRequested) requested_ = now;
  following_.reset();
  if (control == Control::kOwn) {
    Notify(mavlink::kSeverityInfo,
           has_pad_ ? "points the gimbal at the pattern" : "points the gimbal at what is marked");
  }
  if (control != Control::kTaken) return;
  Notify(mavlink::kSeverityWarning,
         fmt::format("{} moves the gimbal: it is left alone until control is handed back, the "
                     "guided mode given anew, or pointing requested on the page",
                     manager_.taken_by()));
}

// Returns the place to which the track leads, or, before there is a track, the place where the pad
// was just seen: a search that went on would not see it again.
std::optional<Vector3d> PointedGimbal::Target(Time then, const TrackSnapshot& track) {
  constexpr double kGlance_s = 1.5;
  if (track.sighting) sighting_ = track.sighting;
  if (track.target && track.state != TrackState::kSearching && track.state != TrackState::kLost) {
    const double ahead_s = std::max(ToSeconds(then - track.captured), 0.0);
    return Propagate(track.target->motion, ahead_s, noise_).position();
  }
  if (!sighting_ || ToSeconds(then - sighting_->time) > kGlance_s) return std::nullopt;
  return sighting_->position_in_world;
}

// A gimbal that neither is where it was sent nor turns there is moved by somebody of whom the
// manager reports nothing, as a ground station's slider. One that is on its way to an aim that runs
// away is not.
void PointedGimbal::WatchFollowing(Time now, const GimbalAngles& aim, double heading) {
  constexpr double kNear = Radians(12.0), kNearer = Radians(3.0);
  constexpr double kPatience_s = 1.5, kOld_s = 1.5;
  if (manager_.control() != Control::kOwn || !report_sample_ ||
      ToSeconds(now - report_sample_->time) > kOld_s) {
    following_.reset();
    return;
  }
  const bool is_in_earth = report_sample_->yaw_frame == YawFrame::kEarth;
  const Eigen::AngleAxisd turn(is_in_earth ? 0 : heading, Vector3d::UnitZ());
  const Vector3d reported = turn * (report_sample_->level_from_platform * Vector3d::UnitX());
  const Vector3d wanted = aim.rotation() * Vector3d::UnitX();
  const double error = AngleBetween(reported, wanted);
  if (following_) {
    following_->progress += AngleBetween(following_->axis, wanted) - error;
    following_->axis = reported;
  }
  if (!following_ || error < kNear || following_->progress > kNearer) {
    following_ = Following{now, 0, reported};
  }
  if (ToSeconds(now - following_->since) < kPatience_s) return;
  manager_.Yield("somebody else, or its own limit,");
}

void PointedGimbal::Notify(std::uint8_t severity, const std::string& text) {
  report_(text);
  autopilot_.Announce(severity, "Kestrel: " + text);
}

}  // namespace kestrel
