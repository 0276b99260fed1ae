// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/autopilot_poses.h"

#include <cmath>

#include "kestrel/comms/mavlink/autopilot_status.h"
#include "kestrel/comms/mavlink/ned.h"

namespace kestrel {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Signed difference, s; correct across the wrap after 49 days.
double SecondsBetween(std::uint32_t from_ms, std::uint32_t to_ms) {
  return 1e-3 * static_cast<std::int32_t>(to_ms - from_ms);
}

Quaterniond FromEulerAngles(double roll, double pitch, double yaw) {
  return Quaterniond(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(pitch, Vector3d::UnitY()) *
                     Eigen::AngleAxisd(roll, Vector3d::UnitX()));
}

bool IsRotation(const Quaterniond& rotation) {
  constexpr double kTolerance = 0.01;
  return std::abs(rotation.norm() - 1) < kTolerance;  // false for NaN
}

}  // namespace

// Packets overtake each other by some milliseconds; several older ones in a row come from a clock
// that has restarted.
PoseFate AutopilotPoses::CheckOrder(std::uint32_t boot_ms, StampOrder* order) {
  constexpr int kRestartAfter = 3;
  constexpr double kRestartBack_s = 1;
  if (!order->newest_ms || SecondsBetween(*order->newest_ms, boot_ms) > 0) {
    *order = {boot_ms, 0};
    return PoseFate::kUsed;
  }
  back_s_ = SecondsBetween(boot_ms, *order->newest_ms);
  if (back_s_ == 0) return PoseFate::kNone;  // a repetition
  order->backwards = back_s_ > kRestartBack_s ? order->backwards + 1 : 0;
  return order->backwards == kRestartAfter ? PoseFate::kRestarted : PoseFate::kBackwards;
}

PoseFate AutopilotPoses::Handle(const mavlink::AttitudeQuaternion& message, Time received,
                                ClockExchange* clock, PoseSample* pose) {
  const Quaterniond rotation(message.q1, message.q2, message.q3, message.q4);
  const Vector3d rate(message.rollspeed, message.pitchspeed, message.yawspeed);
  if (!IsRotation(rotation) || !rate.allFinite()) return PoseFate::kNotFinite;
  const PoseFate fate = CheckOrder(message.time_boot_ms, &attitude_order_);
  if (fate != PoseFate::kUsed) return fate;
  has_quaternions_ = true;
  return MakePose({message.time_boot_ms, rotation.normalized(), rate}, received, clock, pose);
}

// If an autopilot sends both, only the quaternions are used.
PoseFate AutopilotPoses::Handle(const mavlink::Attitude& message, Time received,
                                ClockExchange* clock, PoseSample* pose) {
  constexpr double kQuaternionsEnd_s = 0.5;
  const Vector3d angles(message.roll, message.pitch, message.yaw);
  const Vector3d rate(message.rollspeed, message.pitchspeed, message.yawspeed);
  if (!angles.allFinite() || !rate.allFinite()) return PoseFate::kNotFinite;
  const PoseFate fate = CheckOrder(message.time_boot_ms, &euler_order_);
  if (fate != PoseFate::kUsed) return fate;
  if (has_quaternions_ && attitude_order_.newest_ms &&
      SecondsBetween(*attitude_order_.newest_ms, message.time_boot_ms) < kQuaternionsEnd_s) {
    return PoseFate::kNone;
  }
  has_quaternions_ = false;
  return MakePose({message.time_boot_ms, FromEulerAngles(angles.x(), angles.y(), angles.z()), rate},
                  received, clock, pose);
}

PoseFate AutopilotPoses::Handle(const mavlink::LocalPositionNed& message) {
  const Vector3d position(message.x, message.y, message.z);
  const Vector3d velocity(message.vx, message.vy, message.vz);
  if (!position.allFinite() || !velocity.allFinite()) return PoseFate::kNotFinite;
  const PoseFate fate = CheckOrder(message.time_boot_ms, &position_order_);
  if (fate != PoseFate::kUsed) return fate;
  position_ = {message.time_boot_ms, EnuFromNed(position), EnuFromNed(velocity)};
  return PoseFate::kUsed;
}

PoseFate AutopilotPoses::MakePose(const AttitudeSample& sample, Time received, ClockExchange* clock,
                                  PoseSample* pose) const {
  const std::int64_t remote_ns = NanosecondsOfBoot(sample.boot_ms);
  clock->HandleStamp(remote_ns, received);
  if (!clock->sync().is_known()) return PoseFate::kWithoutClock;
  pose->time = clock->sync().ToLocal(remote_ns);
  pose->time_sigma_s = clock->sync().sigma_s(received);
  pose->world_from_body = {EnuFluFromNedFrd(sample.ned_from_frd).normalized(), Vector3d::Zero()};
  pose->motion = BodyMotion{Vector3d::Zero(), FluFromFrd(sample.rate_in_frd)};
  const double age_s = position_ ? SecondsBetween(position_->boot_ms, sample.boot_ms) : 0;
  if (!position_ || std::abs(age_s) > position_age_s_) return PoseFate::kWithoutPosition;
  pose->motion->velocity_in_world = position_->velocity_in_world;
  pose->world_from_body.translation = position_->in_world + age_s * position_->velocity_in_world;
  return PoseFate::kUsed;
}

// SIM_STATE has no time of its own: the fastest message that arrived at this time gives it.
PoseFate TruePoseOf(const mavlink::SimState& message, AutopilotKind kind,
                    const GlobalPosition& origin, const TimeSync& clock, Time received,
                    PoseSample* pose) {
  if (!clock.is_known()) return PoseFate::kWithoutClock;
  const Quaterniond rotation(message.q1, message.q2, message.q3, message.q4);
  const Vector3d velocity(message.vn, message.ve, message.vd);
  const Vector3d rate(message.xgyro, message.ygyro, message.zgyro);
  if (!IsRotation(rotation) || !velocity.allFinite() || !rate.allFinite() ||
      !std::isfinite(message.alt)) {
    return PoseFate::kNotFinite;
  }
  pose->time = received - clock.round_trip() / 2;
  pose->world_from_body = {
      EnuFluFromNedFrd(rotation).normalized(),
      LocalFromGlobal(kind, origin, {message.lat_int, message.lon_int, message.alt})};
  pose->motion = BodyMotion{EnuFromNed(velocity), FluFromFrd(rate)};
  return PoseFate::kUsed;
}

PoseFate TruePoseOf(const mavlink::HilStateQuaternion& message, AutopilotKind kind,
                    const GlobalPosition& origin, const TimeSync& clock, PoseSample* pose) {
  constexpr std::uint64_t kMaxStamp_us = std::uint64_t{1} << 50;
  if (!clock.is_known()) return PoseFate::kWithoutClock;
  const auto& q = message.attitude_quaternion;
  const Quaterniond rotation(q[0], q[1], q[2], q[3]);
  const Vector3d rate(message.rollspeed, message.pitchspeed, message.yawspeed);
  if (!IsRotation(rotation) || !rate.allFinite() || message.time_usec >= kMaxStamp_us) {
    return PoseFate::kNotFinite;
  }
  pose->time = clock.ToLocal(static_cast<std::int64_t>(1000 * message.time_usec));
  pose->world_from_body = {
      EnuFluFromNedFrd(rotation).normalized(),
      LocalFromGlobal(kind, origin, {message.lat, message.lon, 1e-3 * message.alt})};
  pose->motion =
      BodyMotion{EnuFromNed(Vector3d(message.vx, message.vy, message.vz) / 100), FluFromFrd(rate)};
  return PoseFate::kUsed;
}

}  // namespace kestrel
