// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/tracking_camera.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/target_profile.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/tracking/turn_motion.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr double kFollowTarget_hz = 4;
// From the arrival of a picture at a ground station until a person sees it: the receiver's buffer
// (Mission Planner's has 41 ms), decoder and screen.
constexpr Duration kDisplay = std::chrono::milliseconds(100);

// Returns the angle between the lines of sight at two opposite edges, deg.
double FieldOfView_deg(const CameraModel& camera, const Eigen::Vector2d& edge,
                       const Eigen::Vector2d& other) {
  double angle = 0;
  for (const Eigen::Vector2d& pixel : {edge, other}) {
    Vector3d ray;
    const bool is_known = camera.Unproject(pixel, &ray) != ProjectionStatus::kOutsideModel;
    angle += is_known ? std::acos(std::clamp(ray.z(), -1.0, 1.0)) : camera.max_angle();
  }
  return Degrees(angle);
}

CameraDescription DescriptionOf(const ConnectionOptions& link, const CameraCalibration& calibration,
                                const CameraStream& stream) {
  const CameraModel camera(calibration.intrinsics);
  const CameraIntrinsics& lens = calibration.intrinsics;
  const double right = lens.width_px - 1, bottom = lens.height_px - 1;
  return {.component = static_cast<std::uint8_t>(link.camera_id),
          .model = calibration.name.empty() ? "camera" : calibration.name,
          .width_px = lens.width_px,
          .height_px = lens.height_px,
          .horizontal_fov_deg = FieldOfView_deg(camera, {0, lens.cy_px}, {right, lens.cy_px}),
          .vertical_fov_deg = FieldOfView_deg(camera, {lens.cx_px, 0}, {lens.cx_px, bottom}),
          .gimbal_device_id =
              static_cast<std::uint8_t>(calibration.gimbal ? calibration.gimbal->device_id : 0),
          .stream_uri = stream.uri,
          .stream_rate_hz = stream.rate_hz};
}

// The pixel (x, y) of a box is its upper left one.
cv::Rect2d BoxOf(const ImageRegion& region, const cv::Size& size) {
  return {region.left * size.width, region.top * size.height,
          (region.right - region.left) * size.width, (region.bottom - region.top) * size.height};
}

// The part of the box that is in the image.
ImageRegion RegionOf(const cv::Rect2d& box, const cv::Size& size) {
  const auto share = [](double position, int length) {
    return std::clamp(position / length, 0.0, 1.0);
  };
  return {share(box.x, size.width), share(box.y, size.height), share(box.x + box.width, size.width),
          share(box.y + box.height, size.height)};
}

}  // namespace

TrackingCamera::TrackingCamera(const FlightOptions& options, const CameraCalibration& calibration,
                               const CameraStream& stream, Autopilot* autopilot,
                               Connection* connection,
                               std::function<void(const std::string&)> report)
    : options_(options),
      size_px_(calibration.intrinsics.width_px, calibration.intrinsics.height_px),
      delay_(stream.delay),
      autopilot_(*autopilot),
      connection_(*connection),
      report_(std::move(report)),
      writer_(connection->system(), static_cast<std::uint8_t>(options.link.camera_id)),
      component_(
          DescriptionOf(options.link, calibration, stream),
          {.send =
               [this](const CameraMessage& message) {
                 std::visit([this](const auto& one) { connection_.SendBy(&writer_, one); },
                            message);
               },
           .mark =
               [this](int request, const ImageRegion& region, Time time) {
                 marks_.Push({request, time, time - delay_() - kDisplay, BoxOf(region, size_px_)});
               },
           .stop = [this] { marks_.Push({}); },
           .report =
               [this](const std::string& text, bool is_warning) {
                 report_(text);
                 autopilot_.Announce(
                     is_warning ? mavlink::kSeverityWarning : mavlink::kSeverityInfo,
                     "Kestrel: " + text);
               }}),
      follow_target_(kFollowTarget_hz) {
  if (options.link.camera_id != options.link.component_id) return;
  throw InputError(
      fmt::format("fly.link.camera_id is {} as fly.link.component_id, expected another",
                  options.link.camera_id));
}

void TrackingCamera::Handle(const mavlink::Packet& packet, Time received) {
  component_.Handle(packet, connection_.system(), received);
}

void TrackingCamera::Tick(Time now, const TrackSnapshot& track, const PoseHistory& poses) {
  constexpr Duration kPeriod = std::chrono::milliseconds(10);
  if (now < due_ || autopilot_.system() == 0) return;  // 0: the vehicle's id is not known yet
  due_ = now + kPeriod;
  while (const auto outcome = outcomes_.TryPop()) {
    component_.Answer(outcome->request, outcome->refusal);
  }
  component_.Tick(now, TrackingAt(now, track, poses));
}

// A mark that was refused meanwhile, as there was no frame, is not followed later.
void TrackingCamera::ApplyMarks(Time now, Vision* vision) {
  while (const auto mark = marks_.TryPop()) {
    if (!mark->box_px) {
      vision->Unmark();
      continue;
    }
    if (now - mark->received > CameraComponent::kMarkPatience) continue;
    std::string refusal;
    try {
      vision->Mark(mark->shown, *mark->box_px);
    } catch (const InputError& error) {
      refusal = error.what();
    }
    outcomes_.Push({mark->request, std::move(refusal)});
  }
}

CameraTracking TrackingCamera::TrackingAt(Time now, const TrackSnapshot& track,
                                          const PoseHistory& poses) {
  CameraTracking tracking{.state = StateAt(now, track)};
  if (tracking.state == CameraTracking::State::kIdle ||
      tracking.state == CameraTracking::State::kLost) {
    return tracking;
  }
  tracking.region = RegionOf(track.followed->region->box_px, size_px_);
  const auto target = TargetAt(now, track, poses);
  if (!target || !autopilot_.origin()) return tracking;
  tracking.place = GeoStatusOf(*target, autopilot_.kind(), *autopilot_.origin());
  if (options_.messages.sends_follow_target) SendFollowTarget(now, *target);
  return tracking;
}

// Pictures that do not come any more show where the thing was: it coasts, then it is lost. What is
// lost for long is not reported as such any more, until it is found again.
CameraTracking::State TrackingCamera::StateAt(Time now, const TrackSnapshot& track) {
  using State = CameraTracking::State;
  constexpr Duration kFresh = std::chrono::milliseconds(500), kCoasts = std::chrono::seconds(1);
  constexpr Duration kReportsLoss = std::chrono::seconds(5);
  if (!track.followed || !track.followed->region) {
    lost_.reset();
    return State::kIdle;
  }
  const RegionState seen = track.followed->region->state;
  const Duration age = now - track.followed->time;
  if (seen == RegionState::kLost || age > kCoasts) {
    if (!lost_) lost_ = now;
    return now - *lost_ < kReportsLoss ? State::kLost : State::kIdle;
  }
  lost_.reset();
  return seen == RegionState::kFollowing && age < kFresh ? State::kActive : State::kCoasting;
}

std::optional<TargetState> TrackingCamera::TargetAt(Time now, const TrackSnapshot& track,
                                                    const PoseHistory& poses) const {
  const auto& target = track.followed->target;
  const bool is_known = target && track.followed->track_state != TrackState::kSearching &&
                        track.followed->track_state != TrackState::kLost;
  constexpr Duration kMaxPoseAge = std::chrono::milliseconds(300);
  const auto pose = poses.Predict(now, kMaxPoseAge, {});
  if (!is_known || !pose) return std::nullopt;
  const double ahead_s = std::max(ToSeconds(now - track.captured), 0.0);
  const TurnState motion =
      Propagate(target->motion, ahead_s, FollowPipelineOptions().Tracker().Noise());
  return TargetState{.time = now,
                     .world_from_body = pose->world_from_body,
                     .position_in_world = motion.position(),
                     .velocity_in_world = motion.velocity(),
                     .covariance = motion.covariance.topLeftCorner<3, 3>()};
}

void TrackingCamera::SendFollowTarget(Time now, const TargetState& target) {
  if (!autopilot_.time_sync().is_known() || !follow_target_.IsDue(now, false)) return;
  constexpr std::int64_t kNsPerMs = 1'000'000;
  const std::int64_t boot_ms = autopilot_.time_sync().ToRemote(now) / kNsPerMs;
  connection_.Send(FollowTargetOf(target, autopilot_.kind(), *autopilot_.origin(),
                                  static_cast<std::uint64_t>(std::max<std::int64_t>(boot_ms, 0))));
}

}  // namespace kestrel
