// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/simulated_mount.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/ned.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr std::uint8_t kDevice = 1;
constexpr LinkId kGroundStation{255, 190};
constexpr Duration kStickTime = std::chrono::seconds(2);
constexpr double kStickRate_dps = 30;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

float Rad(double degrees) { return static_cast<float>(Radians(degrees)); }

}  // namespace

SimulatedMount::SimulatedMount(AutopilotFirmware firmware, const SimulatedMountOptions& options,
                               std::uint8_t system, Time start, Random random)
    : firmware_(firmware),
      options_(options),
      system_(system),
      start_(start),
      random_(random),
      stepped_to_(start),
      report_due_(start),
      commanded_(start) {}

void SimulatedMount::Step(Time now, const RigidTransform& world_from_body) {
  const double seconds = ToSeconds(now - stepped_to_);
  stepped_to_ = now;
  FollowScript(now);
  const double heading = HeadingOf(world_from_body.rotation);
  const GimbalAngles aim = Aim(seconds, heading);
  if (!has_begun_) angles_ = aim;
  has_begun_ = true;
  angles_ = Turned(options_, angles_, aim, seconds);
  if (now < report_due_) return;
  report_due_ += DurationFromSeconds(1 / options_.reports_hz);
  const Quaterniond attitude = options_.echoes ? aim.rotation() : angles_.rotation();
  const double turn = is_px4() ? 0 : -heading;
  reported_ =
      WithNoise(options_, Quaterniond(AngleAxisd(turn, Vector3d::UnitZ()) * attitude), &random_);
}

bool SimulatedMount::IsDue(double after_s, Time now) const {
  return after_s >= 0 && now - start_ >= DurationFromSeconds(after_s);
}

void SimulatedMount::FollowScript(Time now) {
  const bool was_moved = is_stick_moved_;
  is_stick_moved_ =
      IsDue(options_.stick_after_s, now) && !IsDue(options_.stick_after_s, now - kStickTime);
  if (is_stick_moved_ != was_moved) {
    const double rate = is_stick_moved_ ? -Radians(kStickRate_dps) : 0;
    set_point_ = {.value = {0, rate}, .is_rate = true};
    commanded_ = now;
    if (is_px4()) primary_ = {system_, mavlink::kComponentAutopilot};
  }
  if (IsDue(options_.other_after_s, now) && !has_other_taken_) {
    has_other_taken_ = true;
    primary_ = kGroundStation;
    set_point_ = SetPoint();
  }
}

// Returns where the motors turn to, in the world.
GimbalAngles SimulatedMount::Aim(double seconds, double heading) {
  constexpr Duration kRateTimeout = std::chrono::seconds(3);
  if (!set_point_.is_rate) {
    aim_ = set_point_.value;
    if (!set_point_.is_in_earth) aim_.yaw += heading;
  } else if (stepped_to_ - commanded_ < kRateTimeout) {
    aim_.yaw += seconds * set_point_.value.yaw;
    aim_.pitch += seconds * set_point_.value.pitch;
  }
  return aim_ = WithinRange(aim_, heading);
}

GimbalAngles SimulatedMount::WithinRange(GimbalAngles aim, double heading) const {
  const double most = Radians(options_.yaw_max_deg);
  const double off = std::remainder(aim.yaw - heading, 2 * kPi);
  aim.yaw = heading + std::clamp(off, -most, most);
  aim.pitch =
      std::clamp(aim.pitch, -Radians(options_.pitch_max_deg), -Radians(options_.pitch_min_deg));
  return aim;
}

std::uint8_t SimulatedMount::Execute(const mavlink::CommandLong& command, const LinkId& sender,
                                     Time now) {
  if (command.command == mavlink::kCommandGimbalConfigure) {
    constexpr float kMyself = -2, kRelease = -3;
    if (command.param1 >= 0 && command.param2 >= 0) {
      primary_ = {static_cast<std::uint8_t>(command.param1),
                  static_cast<std::uint8_t>(command.param2)};
    } else if (command.param1 == kMyself) {
      // PX4 takes that for itself.
      primary_ = is_px4() ? LinkId{system_, mavlink::kComponentAutopilot} : sender;
    } else if (command.param1 == kRelease && primary_ == sender) {
      primary_ = {};
    }
    return mavlink::kResultAccepted;
  }
  if (is_px4() && sender != primary_) return mavlink::kResultDenied;
  Obey({Radians(command.param1), Radians(command.param2), Radians(command.param3),
        Radians(command.param4), static_cast<std::uint32_t>(command.param5)},
       now);
  return mavlink::kResultAccepted;
}

void SimulatedMount::Handle(const mavlink::GimbalManagerSetPitchyaw& message, const LinkId& sender,
                            Time now) {
  if (is_px4() && sender != primary_) return;
  Obey({message.pitch, message.yaw, message.pitch_rate, message.yaw_rate, message.flags}, now);
}

void SimulatedMount::Obey(const PitchYaw& wanted, Time now) {
  const bool has_angles = std::isfinite(wanted.pitch) && std::isfinite(wanted.yaw);
  const bool has_rates = std::isfinite(wanted.pitch_rate) && std::isfinite(wanted.yaw_rate);
  if (!is_px4() && has_angles && has_rates) return;
  commanded_ = now;
  if (has_angles) {
    const bool is_in_earth = (wanted.flags & mavlink::kGimbalYawLock) != 0;
    const double yaw = is_in_earth ? kPi / 2 - wanted.yaw : -wanted.yaw;
    set_point_ = {{yaw, -wanted.pitch}, false, is_in_earth};
  } else if (has_rates) {
    set_point_ = {{-wanted.yaw_rate, -wanted.pitch_rate}, true};
  }
}

mavlink::GimbalDeviceAttitudeStatus SimulatedMount::AttitudeMessage(std::uint32_t boot_ms) const {
  const Quaterniond frd_from_flu(0, 1, 0, 0);
  const Quaterniond q =
      is_px4() ? NedFrdFromEnuFlu(reported_) : frd_from_flu * reported_ * frd_from_flu;
  const bool is_locked = set_point_.is_in_earth;
  mavlink::GimbalDeviceAttitudeStatus message;
  message.time_boot_ms = boot_ms;
  message.flags = mavlink::kGimbalRollLock | mavlink::kGimbalPitchLock;
  message.flags |= is_px4() ? mavlink::kGimbalYawInEarthFrame : mavlink::kGimbalYawInVehicleFrame;
  if (is_locked) message.flags |= mavlink::kGimbalYawLock;
  message.q = {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()),
               static_cast<float>(q.z())};
  message.angular_velocity_x = message.angular_velocity_y = message.angular_velocity_z = kNan;
  message.delta_yaw = message.delta_yaw_velocity = kNan;
  message.gimbal_device_id = kDevice;
  return message;
}

mavlink::GimbalManagerStatus SimulatedMount::StatusMessage(std::uint32_t boot_ms) const {
  mavlink::GimbalManagerStatus message;
  message.time_boot_ms = boot_ms;
  message.flags = mavlink::kGimbalRollLock | mavlink::kGimbalPitchLock;
  message.gimbal_device_id = kDevice;
  message.primary_control_sysid = primary_.system;
  message.primary_control_compid = primary_.component;
  return message;
}

// PX4 does not know the range of its gimbal.
mavlink::GimbalManagerInformation SimulatedMount::InformationMessage(std::uint32_t boot_ms) const {
  mavlink::GimbalManagerInformation message;
  message.time_boot_ms = boot_ms;
  message.gimbal_device_id = kDevice;
  message.pitch_min = Rad(is_px4() ? -90 : options_.pitch_min_deg);
  message.pitch_max = Rad(is_px4() ? 90 : options_.pitch_max_deg);
  message.yaw_min = Rad(is_px4() ? -180 : -options_.yaw_max_deg);
  message.yaw_max = Rad(is_px4() ? 180 : options_.yaw_max_deg);
  return message;
}

mavlink::RcChannels SimulatedMount::ChannelsMessage(std::uint32_t boot_ms) const {
  constexpr std::uint16_t kCentre_us = 1500, kMoved_us = 1800;
  mavlink::RcChannels message;
  message.time_boot_ms = boot_ms;
  message.chancount = 8;
  message.chan6_raw = kCentre_us;
  message.chan7_raw = is_stick_moved_ ? kMoved_us : kCentre_us;
  return message;
}

}  // namespace kestrel
