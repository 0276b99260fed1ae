// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/simulated_camera.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/hash.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/recordings/landing_simulation.h"
#include "kestrel/simulation/recordings/second_camera.h"
#include "kestrel/simulation/recordings/truth_text.h"
#include "kestrel/simulation/rendering/lens.h"
#include "kestrel/simulation/scene/solids.h"

namespace kestrel {
namespace {

constexpr std::size_t kCameraPoses = 1000;
// Longest gap of the autopilot's link over which a pose is still interpolated.
constexpr Duration kLongestPoseGap = std::chrono::milliseconds(500);

constexpr double kLate_s = 0.3;
constexpr double kTurned_deg = 5;

// Returns the camera with 'scale' times its pixels. The corners of the image stay.
CameraCalibration Scaled(CameraCalibration calibration, double scale) {
  CameraIntrinsics& lens = calibration.intrinsics;
  lens.width_px = static_cast<int>(std::lround(scale * lens.width_px));
  lens.height_px = static_cast<int>(std::lround(scale * lens.height_px));
  lens.fx_px *= scale;
  lens.fy_px *= scale;
  lens.cx_px = scale * (lens.cx_px + 0.5) - 0.5;
  lens.cy_px = scale * (lens.cy_px + 0.5) - 0.5;
  return calibration;
}

// Returns the paper's camera, or the one for a thing to follow or for a field of objects; on a
// gimbal if there is one.
CameraCalibration FirstCalibration(const VehicleWorld& world, double scale,
                                   const std::optional<GimbalMount>& gimbal) {
  CameraCalibration calibration = PaperCalibration();
  if (world.options().thing.is_there()) calibration = FollowCalibration();
  if (world.options().field.is_there()) calibration = HuntCalibration();
  calibration = Scaled(calibration, scale);
  if (gimbal) {
    calibration.gimbal = gimbal;
    calibration.body_from_camera = gimbal->body_from_pivot * gimbal->platform_from_camera;
  }
  return calibration;
}

}  // namespace

SimulatedCameraOptions SimulatedCameraOptions::OfSecond() const {
  SimulatedCameraOptions options = *this;
  options.clock_offset_s = second.clock_offset_s;
  options.fault = second.fault;
  options.second = {};
  options.zoom = {};
  return options;
}

CameraCalibration SimulatedCamera::CalibrationOfSecond(const SimulatedCameraOptions& options) {
  return Scaled(SecondCalibration(options.second.fov_deg, options.second.tilt_deg), options.scale);
}

// Few rays, so that an image takes a few ms.
SimulatedCameraOptions::SimulatedCameraOptions() { shutter.rays_per_pixel = 3; }

SimulatedCamera::SimulatedCamera(const SimulatedCameraOptions& options, VehicleWorld* world,
                                 Time start, std::uint64_t seed,
                                 const std::optional<GimbalMount>& gimbal)
    : SimulatedCamera(options, world, start, seed,
                      FirstCalibration(*world, options.scale, gimbal)) {}

SimulatedCamera::SimulatedCamera(const SimulatedCameraOptions& options, VehicleWorld* world,
                                 Time start, std::uint64_t seed,
                                 const CameraCalibration& calibration)
    : options_(Checked(options)),
      world_(*world),
      start_(start),
      seed_(seed),
      calibration_(calibration),
      drawn_(world->scene().world),
      poses_(kCameraPoses, kLongestPoseGap),
      platforms_(calibration.gimbal ? kCameraPoses : 0) {
  const SurroundingsOptions& surroundings = world->options().surroundings;
  if (surroundings.uav_shadow) {
    constexpr double kSize_m = 0.8;  // from rotor to rotor
    drawn_.bodies.push_back([this](double time_s) { return BodyAt(time_s); });
    AddUavShadow(static_cast<int>(drawn_.bodies.size()) - 1, kSize_m, &drawn_);
  }
  LensOptions lens;
  lens.half_angle_deg = options.lens.half_angle_deg;
  lens.vignette = options.lens.vignette;
  if (surroundings.landing_legs) lens.airframe = LandingLegs(calibration_.intrinsics, true);
  const CameraIntrinsics& own = calibration_.intrinsics;
  if (options.zoom.is_there()) calibration_.zoom = ZoomLens{{{ViewOf(own), own}}, {}};
  camera_ = std::make_unique<const ZoomingCamera>(
      options.zoom, own, [this, lens](const CameraIntrinsics& zoomed) {
        return std::make_shared<const FlightCamera>(
            CameraModel(zoomed), lens, options_.shutter, options_.sensor, drawn_,
            [this](double time_s) { return CameraAt(time_s); });
      });
  world_.ListenToPoses(
      this, [this](const PoseSample& pose, const VehicleWorld::PlatformAttitude& platform) {
        Place(pose, platform, true);
      });
}

void SimulatedCamera::AddPose(const PoseSample& pose) {
  Place(pose, std::nullopt, false);
  world_.ObserveUav(pose.time, pose.world_from_body.translation);
}

void SimulatedCamera::Place(const PoseSample& pose, const VehicleWorld::PlatformAttitude& platform,
                            bool is_true) {
  {
    const std::lock_guard lock(mutex_);
    if (has_true_poses_ && !is_true) return;
    has_true_poses_ = is_true;
    if (poses_.Add(pose) != PoseStatus::kOk) return;
    newest_pose_ = pose;
    if (platform) platforms_.Add({pose.time, *platform, YawFrame::kEarth});
  }
  pose_came_.notify_one();
}

bool SimulatedCamera::Next(Frame* frame, Duration timeout) {
  const Time deadline = Now() + timeout;
  for (;;) {
    const Time capture = NextCapture();
    if (capture > deadline) break;
    if (IsLeftOut(capture)) {
      ++next_;
      continue;
    }
    std::this_thread::sleep_for(capture - Now());
    WaitForPose(capture, deadline);
    ++next_;
    if (auto captured = Capture(capture)) {
      *frame = std::move(*captured);
      return true;
    }
    ++left_out_;
  }
  std::this_thread::sleep_for(deadline - Now());
  return false;
}

CameraFault SimulatedCamera::FaultAt(Time capture) const {
  return options_.fault.At(ToSeconds(capture - start_));
}

// True when its fault leaves the image out.
bool SimulatedCamera::IsLeftOut(Time capture) const {
  constexpr double kSlow_hz = 3;
  const CameraFault fault = FaultAt(capture);
  if (fault == CameraFault::kStopped) return true;
  const auto slower = static_cast<std::int64_t>(std::max(options_.rate_hz / kSlow_hz, 1.0));
  return fault == CameraFault::kSlow && next_ % slower != 0;
}

// Returns the time of the next image: the newest one that is due and whose pose is known, or the
// next one. Poses that come late delay the images and leave none out.
Time SimulatedCamera::NextCapture() {
  const double due = std::floor(ToSeconds(KnownTime() - start_) * options_.rate_hz);
  const auto newest = static_cast<std::int64_t>(due);
  if (newest > next_) {
    left_out_ += newest - next_;
    next_ = newest;
  }
  return start_ + DurationFromSeconds(static_cast<double>(next_) / options_.rate_hz);
}

// Returns the time of the newest pose, within what is waited for.
Time SimulatedCamera::KnownTime() {
  const Time now = Now();
  const std::lock_guard lock(mutex_);
  const Time oldest = now - DurationFromSeconds(options_.pose_wait_s);
  return newest_pose_ ? std::clamp(newest_pose_->time, oldest, now) : now;
}

void SimulatedCamera::WaitForPose(Time capture, Time deadline) {
  std::unique_lock lock(mutex_);
  const Time until = std::min(deadline, capture + DurationFromSeconds(options_.pose_wait_s));
  pose_came_.wait_for(lock, until - Now(),
                      [&] { return newest_pose_ && newest_pose_->time >= capture; });
}

std::optional<Frame> SimulatedCamera::Capture(Time capture) {
  const CameraFault fault = FaultAt(capture);
  const double late_s = fault == CameraFault::kLate ? kLate_s : 0;
  const auto snapshot = SnapshotAt(capture - DurationFromSeconds(late_s));
  if (!snapshot) return std::nullopt;
  snapshot_ = *snapshot;
  snapshot_.is_turned = fault == CameraFault::kTurned;
  constexpr double kBeside_m = 1.5;
  constexpr double kBright = 30;
  if (fault == CameraFault::kBeside) snapshot_.world_from_body.translation.x() += kBeside_m;
  const auto noise = static_cast<std::uint64_t>(ToNanoseconds(capture));
  Frame frame;
  frame.time = StampOf(capture);
  frame.name = fmt::format("{}.png", ToNanoseconds(frame.time));
  if (fault == CameraFault::kFrozen && !last_image_.empty()) {
    frame.image = last_image_.clone();
    return frame;
  }
  const double gain = fault == CameraFault::kBright ? kBright : 1;
  const auto camera = camera_->At(snapshot_.time_s);
  frame.image = camera->Capture(snapshot_.time_s, gain, Hash(seed_, noise));
  if (fault == CameraFault::kBlack) frame.image.setTo(0);
  if (options_.fault.kind == "frozen") last_image_ = frame.image.clone();
  return frame;
}

// Returns the pose at 'capture' and its motion, from the poses around it; from the newest one where
// none is later.
std::optional<SimulatedCamera::Snapshot> SimulatedCamera::SnapshotAt(Time capture) {
  constexpr Duration kStep = std::chrono::milliseconds(10);
  const std::lock_guard lock(mutex_);
  if (!newest_pose_ || capture - newest_pose_->time > kLongestPoseGap) return std::nullopt;
  Snapshot snapshot;
  snapshot.time_s = world_.SceneTime(capture);
  if (calibration_.gimbal && !AddPlatform(capture, &snapshot)) return std::nullopt;
  if (const auto pose = poses_.Lookup(capture)) {
    snapshot.world_from_body = *pose;
    if (const auto before = poses_.Lookup(capture - kStep)) {
      const double step_s = ToSeconds(kStep);
      snapshot.motion.velocity_in_world = (pose->translation - before->translation) / step_s;
      snapshot.motion.rate_in_body =
          RotationVector(before->rotation.conjugate() * pose->rotation) / step_s;
    }
    return snapshot;
  }
  if (capture < newest_pose_->time) return std::nullopt;  // within a gap, or too long ago
  snapshot.motion = newest_pose_->motion.value_or(BodyMotion());
  const double since_s = ToSeconds(capture - newest_pose_->time);
  snapshot.world_from_body = newest_pose_->world_from_body;
  snapshot.world_from_body.translation += since_s * snapshot.motion.velocity_in_world;
  snapshot.world_from_body.rotation =
      (snapshot.world_from_body.rotation * RotationBy(since_s * snapshot.motion.rate_in_body))
          .normalized();
  return snapshot;
}

RigidTransform SimulatedCamera::BodyAt(double time_s) const {
  const double since_s = time_s - snapshot_.time_s;
  const RigidTransform& pose = snapshot_.world_from_body;
  return {(pose.rotation * RotationBy(since_s * snapshot_.motion.rate_in_body)).normalized(),
          pose.translation + since_s * snapshot_.motion.velocity_in_world};
}

// Sets the gimbal's attitude and its rate; false where it is not known.
bool SimulatedCamera::AddPlatform(Time capture, Snapshot* snapshot) const {
  constexpr Duration kStep = std::chrono::milliseconds(10);
  const auto attitude = platforms_.At(capture, kStep);
  const auto before = platforms_.At(capture - kStep, kStep);
  if (!attitude || !before) return false;
  snapshot->world_from_platform = attitude->level_from_platform;
  snapshot->platform_rate =
      RotationVector(before->level_from_platform.conjugate() * attitude->level_from_platform) /
      ToSeconds(kStep);
  return true;
}

RigidTransform SimulatedCamera::CameraAt(double time_s) const {
  RigidTransform body = BodyAt(time_s);
  if (snapshot_.is_turned) {
    body.rotation = body.rotation * RotationBy({Radians(kTurned_deg), 0, 0});
  }
  const auto& gimbal = calibration_.gimbal;
  if (!gimbal) return body * *calibration_.body_from_camera;
  const double since_s = time_s - snapshot_.time_s;
  const GimbalAttitude attitude{
      snapshot_.world_from_platform * RotationBy(since_s * snapshot_.platform_rate),
      YawFrame::kEarth};
  return WorldFromPlatform(body, gimbal->body_from_pivot, attitude) * gimbal->platform_from_camera;
}

Time SimulatedCamera::StampOf(Time capture) const {
  return capture - DurationFromSeconds(options_.clock_offset_s);
}

Time SimulatedCamera::CaptureOf(Time stamp) const {
  return stamp + DurationFromSeconds(options_.clock_offset_s);
}

RigidTransform SimulatedCamera::PatternAt(Time stamp) const {
  return world_.PatternAt(CaptureOf(stamp));
}

std::optional<TruePattern> SimulatedCamera::Truth(const Frame& frame) const {
  const double time_s = world_.SceneTime(CaptureOf(frame.time));
  return SeenPattern(frame.time, time_s, *camera_->At(time_s), world_.scene().print,
                     world_.scene().world_from_pattern);
}

}  // namespace kestrel
