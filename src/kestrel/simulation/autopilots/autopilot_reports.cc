// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/core/camera/zoom_lens.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/autopilots/autopilot_model.h"

// Messages that the simulated autopilot sends.
namespace kestrel {

// PX4 sends texts only where a ground station listens; others get events, which nobody here needs.
void AutopilotModel::SendText(Severity severity, const std::string& text) const {
  if (is_px4() && !has_gcs_) return;
  mavlink::Statustext message;
  message.severity = static_cast<std::uint8_t>(severity);
  message.text = CharsOf<50>(text);
  send_(message);
}

// PX4's LAND without a position, which it takes for a failsafe.
bool AutopilotModel::Descends() const {
  return is_px4() && LacksPosition() && IsIn(FlightMode::kLand);
}

std::uint8_t AutopilotModel::LandedState() const {
  if (!is_armed_ || detector_.has_landed()) return mavlink::kLandedOnGround;
  if (Descends()) return mavlink::kLandedInAir;
  if (LandsByTarget() || IsIn(FlightMode::kLand)) return mavlink::kLandedLanding;
  return mavlink::kLandedInAir;
}

mavlink::Heartbeat AutopilotModel::HeartbeatOf() const {
  constexpr std::uint8_t kVersion = 3;
  mavlink::Heartbeat message;
  message.type = static_cast<std::uint8_t>(options_.vehicle_type);
  message.autopilot = is_px4() ? mavlink::kAutopilotPx4 : mavlink::kAutopilotArduPilot;
  message.base_mode = mavlink::kModeFlagCustom;
  if (is_armed_) message.base_mode |= mavlink::kModeFlagArmed;
  message.custom_mode = ReportedMode();
  message.system_status = is_armed_ ? mavlink::kStateActive : mavlink::kStateStandby;
  if (is_in_failsafe_ || Descends()) message.system_status = mavlink::kStateCritical;
  message.mavlink_version = kVersion;
  return message;
}

mavlink::AutopilotVersion AutopilotModel::VersionOf() const {
  // Major, minor, patch, type (255: a release; 0: in development).
  constexpr std::uint32_t kArduPilot47 = 4u << 24 | 7u << 16;
  constexpr std::uint32_t kPx4118 = 1u << 24 | 18u << 16;
  mavlink::AutopilotVersion message;
  message.flight_sw_version = is_px4() ? kPx4118 : kArduPilot47;
  constexpr std::uint64_t kSpeaksMavlink2 = 8192;
  message.capabilities = kSpeaksMavlink2;
  message.uid = static_cast<std::uint64_t>(options_.system_id);
  return message;
}

// False when it cannot send that message.
bool AutopilotModel::SendMessage(std::uint32_t id, Time now) {
  switch (id) {
    case mavlink::Heartbeat::kId:
      send_(HeartbeatOf());
      return true;
    case mavlink::CurrentMode::kId:
      send_(mavlink::CurrentMode{
          .standard_mode = 0, .custom_mode = ReportedMode(), .intended_custom_mode = custom_mode_});
      return true;
    case mavlink::ExtendedSysState::kId:
      send_(mavlink::ExtendedSysState{.vtol_state = 0, .landed_state = LandedState()});
      return true;
    case mavlink::SysStatus::kId:
      send_(SysStatusOf(pilot_.has_low_battery(), pilot_.has_sticks()));
      return true;
    case mavlink::RcChannels::kId:
      if (mount_ || !pilot_.has_sticks()) return SendMount(id);
      send_(mavlink::RcChannels{.chancount = 8, .chan3_raw = 1500});
      return true;
    case mavlink::Timesync::kId:
      send_(mavlink::Timesync{.tc1 = 0, .ts1 = OwnTime(now)});
      return true;
    case mavlink::AutopilotVersion::kId:
      send_(VersionOf());
      return true;
    default:
      return SendPose(id, now) || SendPlace(id, now) || SendMount(id) || SendView(id, now);
  }
}

// Sends messages of its estimate.
bool AutopilotModel::SendPose(std::uint32_t id, Time now) {
  const PoseSample& pose = state_.pose;
  const auto own_ms = static_cast<std::uint32_t>(state_.boot_us / 1000);
  const EstimateFaultOptions& faults = options_.estimate;
  const bool is_silent = IsWithin(now, faults.silent_after_s, faults.silent_for_s);
  const bool has_position = HasPosition(now);
  switch (id) {
    case mavlink::Attitude::kId: {
      mavlink::Attitude message = AttitudeOf(pose, own_ms);
      if (nan_attitude_) message.roll = std::numeric_limits<float>::quiet_NaN();
      if (!is_silent) send_(message);
      return true;
    }
    case mavlink::AttitudeQuaternion::kId: {
      mavlink::AttitudeQuaternion message = AttitudeQuaternionOf(pose, own_ms);
      if (nan_attitude_) message.q1 = std::numeric_limits<float>::quiet_NaN();
      if (!is_silent) send_(message);
      return true;
    }
    case mavlink::RawImu::kId:
      send_(RawImuOf(acceleration_ + Vibration(), state_.boot_us));
      return true;
    case mavlink::HighresImu::kId:
      send_(HighresImuOf(acceleration_ + Vibration(), state_.boot_us));
      return true;
    case mavlink::GpsRawInt::kId:
      send_(mavlink::GpsRawInt{.fix_type = static_cast<std::uint8_t>(external_ ? 1 : 3)});
      return true;
    case mavlink::DistanceSensor::kId:
      send_(RangeOf(HeightAboveGround(now), own_ms));
      return true;
    case mavlink::VfrHud::kId: {
      mavlink::VfrHud message;
      message.alt = static_cast<float>(pose.world_from_body.translation.z());
      message.climb = static_cast<float>(pose.motion->velocity_in_world.z());
      if (!is_silent) send_(message);
      return true;
    }
    case mavlink::LocalPositionNed::kId:
      if (!is_silent && has_position) send_(LocalPositionOf(pose, own_ms));
      return true;
    case mavlink::GlobalPositionInt::kId:
      if (!is_silent && has_position && has_origin_)
        send_(GlobalPositionOf(pose, options_.origin, own_ms));
      return true;
    case mavlink::EkfStatusReport::kId:
      send_(mavlink::EkfStatusReport{.flags = EstimatorFlags(has_position)});
      return !is_px4();
    case mavlink::EstimatorStatus::kId:
      send_(mavlink::EstimatorStatus{.time_usec = static_cast<std::uint64_t>(state_.boot_us),
                                     .flags = EstimatorFlags(has_position)});
      return is_px4();
    default:
      return false;
  }
}

Eigen::Vector3d AutopilotModel::Vibration() {
  return options_.estimate.vibration *
         Eigen::Vector3d(shakes_.Normal(), shakes_.Normal(), shakes_.Normal());
}

// Along the body's axis, of what the vehicle's board or the ground is.
double AutopilotModel::HeightAboveGround(Time now) const {
  const RigidTransform& body = uav_.pose().world_from_body;
  const RigidTransform pattern = world_.PatternAt(now);
  const Eigen::Vector3d in_pattern = pattern.Inverse() * body.translation;
  const bool is_above_board = in_pattern.z() > 0 && world_.IsOnBoard(in_pattern);
  const double height_m = is_above_board ? in_pattern.z() : body.translation.z();
  return height_m / std::max((body.rotation * Eigen::Vector3d::UnitZ()).z(), 0.5);
}

// Sends messages of its gimbal, stamped at sending.
bool AutopilotModel::SendMount(std::uint32_t id) const {
  if (!mount_) return false;
  const auto own_ms = static_cast<std::uint32_t>(state_.boot_us / 1000);
  switch (id) {
    case mavlink::GimbalDeviceAttitudeStatus::kId:
      send_(mount_->AttitudeMessage(own_ms));
      return true;
    case mavlink::GimbalManagerStatus::kId:
      send_(mount_->StatusMessage(own_ms));
      return true;
    case mavlink::GimbalManagerInformation::kId:
      send_(mount_->InformationMessage(own_ms));
      return true;
    case mavlink::RcChannels::kId:
      send_(mount_->ChannelsMessage(own_ms));
      return true;
    default:
      return false;
  }
}

// Sends the field of view of its camera, as that has last reported it.
bool AutopilotModel::SendView(std::uint32_t id, Time now) const {
  const ZoomOptions& zoom = options_.zoom;
  if (id != mavlink::CameraFovStatus::kId || !zoom.is_there()) return false;
  const double since_s = world_.SceneTime(now);
  const double reported_s = std::floor(since_s * zoom.rate_hz) / zoom.rate_hz;
  const std::int64_t age_us = std::llround(1e6 * (since_s - reported_s));
  mavlink::CameraFovStatus message;
  message.time_boot_ms = static_cast<std::uint32_t>((OwnMicroseconds(now) - age_us) / 1000);
  message.hfov =
      static_cast<float>(Degrees(ViewOf(ZoomedLens(zoom, options_.zoomed_lens, reported_s))));
  message.camera_device_id = 1;
  send_(message);
  return true;
}

bool AutopilotModel::SendPlace(std::uint32_t id, Time now) {
  const std::int64_t own_us = OwnMicroseconds(now);
  switch (id) {
    case mavlink::GpsGlobalOrigin::kId:
      if (has_origin_) send_(GlobalOriginOf(options_.origin, own_us));
      return has_origin_;
    case mavlink::HomePosition::kId:
      if (!options_.estimate.has_home || !has_origin_) return false;
      send_(HomePositionOf(options_.origin, options_.uav.leg_m, own_us));
      return true;
    case mavlink::SimState::kId:
      send_(SimStateOf(uav_.pose(), options_.origin));
      return true;
    default:
      return false;
  }
}

}  // namespace kestrel
