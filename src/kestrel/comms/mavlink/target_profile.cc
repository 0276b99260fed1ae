// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/target_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/ned.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using Quaternion = std::array<float, 4>;  // w, x, y, z

// Returns the one of the two quaternions of a rotation that has w >= 0.
Quaternion ToWire(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0 ? -1 : 1;
  return {static_cast<float>(sign * rotation.w()), static_cast<float>(sign * rotation.x()),
          static_cast<float>(sign * rotation.y()), static_cast<float>(sign * rotation.z())};
}

// Rotation to NED from the target's own frame: forward, right, down.
Eigen::Quaterniond NedFromTarget(const TargetState& report) {
  const double heading = std::numbers::pi / 2 - report.yaw.value_or(std::numbers::pi / 2);
  return Eigen::Quaterniond(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()));
}

Eigen::Quaterniond NedFromBody(const TargetState& report) {
  return NedFrdFromEnuFlu(report.world_from_body.rotation);
}

float ToFloat(double value) { return static_cast<float>(value); }

// Makes the part of LANDING_TARGET that is the same in both frames.
mavlink::LandingTarget MakeLandingTarget(const TargetState& report, std::uint64_t stamp_us,
                                         std::uint8_t frame, const Eigen::Vector3d& position,
                                         const Eigen::Quaterniond& rotation) {
  const Eigen::Vector3d in_frd = FrdFromFlu(report.position_in_body());
  const double distance = in_frd.norm();
  mavlink::LandingTarget message;
  message.time_usec = stamp_us;
  message.frame = frame;
  message.angle_x = ToFloat(std::atan2(in_frd.y(), in_frd.z()));
  message.angle_y = ToFloat(std::atan2(-in_frd.x(), in_frd.z()));
  message.distance = ToFloat(distance);
  message.size_x = message.size_y =
      ToFloat(distance > 0 ? 2 * std::atan(report.size_m / 2 / distance) : 0);
  message.x = ToFloat(position.x());
  message.y = ToFloat(position.y());
  message.z = ToFloat(position.z());
  message.q = ToWire(rotation);
  message.type = mavlink::kTargetTypeVisionOther;
  message.position_valid = 1;
  return message;
}

// Returns the report's time on the autopilot's clock, us; nothing when that clock is not known.
std::optional<std::uint64_t> StampOf(const Autopilot& autopilot, Time time) {
  if (!autopilot.time_sync().is_known()) return std::nullopt;
  constexpr std::int64_t kNsPerUs = 1000;
  return static_cast<std::uint64_t>(
      std::max<std::int64_t>(autopilot.time_sync().ToRemote(time), 0) / kNsPerUs);
}

}  // namespace

const char* ToString(LinkProfile profile) {
  switch (profile) {
    case LinkProfile::kArduPilot:
      return "ardupilot";
    case LinkProfile::kPx4:
      return "px4";
    case LinkProfile::kPx4Vte:
      return "px4-vte";
  }
  return "";
}

LinkProfile ParseLinkProfile(const std::string& name) {
  for (const LinkProfile profile :
       {LinkProfile::kArduPilot, LinkProfile::kPx4, LinkProfile::kPx4Vte}) {
    if (name == ToString(profile)) return profile;
  }
  throw InputError(
      fmt::format("profile '{}' is not known, expected auto, ardupilot, px4 or px4-vte", name));
}

LinkProfile ProfileFor(AutopilotKind kind) {
  return kind == AutopilotKind::kPx4 ? LinkProfile::kPx4 : LinkProfile::kArduPilot;
}

mavlink::LandingTarget LandingTargetForArduPilot(const TargetState& report,
                                                 std::uint64_t stamp_us) {
  const Eigen::Quaterniond rotation = report.yaw
                                          ? NedFromBody(report).conjugate() * NedFromTarget(report)
                                          : Eigen::Quaterniond::Identity();
  return MakeLandingTarget(report, stamp_us, mavlink::kFrameBodyFrd,
                           FrdFromFlu(report.position_in_body()), rotation);
}

mavlink::LandingTarget LandingTargetForPx4(const TargetState& report, std::uint64_t stamp_us) {
  return MakeLandingTarget(report, stamp_us, mavlink::kFrameLocalNed,
                           NedFromEnu(report.position_in_world), NedFromTarget(report));
}

mavlink::TargetRelative TargetRelativeForPx4(const TargetState& report, std::uint64_t stamp_us) {
  constexpr double kLeastSigma_m = 0.01;
  const Eigen::Vector3d in_frd = FrdFromFlu(report.position_in_body());
  const Eigen::Matrix3d world_from_body = report.world_from_body.rotation.toRotationMatrix();
  const Eigen::Matrix3d in_body = world_from_body.transpose() * report.covariance * world_from_body;
  mavlink::TargetRelative message;
  message.timestamp = stamp_us;
  message.frame = mavlink::kTargetFrameBodyFrd;
  message.x = ToFloat(in_frd.x());
  message.y = ToFloat(in_frd.y());
  message.z = ToFloat(in_frd.z());
  for (int i = 0; i < 3; ++i) {
    message.pos_std[i] = ToFloat(std::max(std::sqrt(std::max(in_body(i, i), 0.0)), kLeastSigma_m));
  }
  message.yaw_std = ToFloat(report.yaw ? report.yaw_sigma : std::numbers::pi);
  message.q_target = ToWire(NedFromBody(report).conjugate() * NedFromTarget(report));
  message.q_sensor = ToWire(NedFromBody(report));
  // PX4 was seen to accept this type; it knows no other type of vision.
  message.type = mavlink::kTargetTypeVisionFiducial;
  return message;
}

std::optional<mavlink::DistanceSensor> DistanceSensorOf(const TargetState& report, double max_m,
                                                        std::uint32_t boot_ms) {
  constexpr double kMin_m = 0.1;
  constexpr double kLeastUpright = 0.5;  // cosine of the tilt
  constexpr double kCentimetres = 100;
  constexpr double kUnknownCovariance = 255;
  const double height_m = report.world_from_body.translation.z() - report.position_in_world.z();
  const double upright = (report.world_from_body.rotation * Eigen::Vector3d::UnitZ()).z();
  const double distance_m = height_m / upright;
  if (!(upright > kLeastUpright && distance_m >= kMin_m && distance_m <= max_m))
    return std::nullopt;
  const double variance_cm2 = report.covariance(2, 2) * kCentimetres * kCentimetres;
  mavlink::DistanceSensor message;
  message.time_boot_ms = boot_ms;
  message.min_distance = static_cast<std::uint16_t>(std::lround(kMin_m * kCentimetres));
  message.max_distance = static_cast<std::uint16_t>(std::lround(max_m * kCentimetres));
  message.current_distance = static_cast<std::uint16_t>(std::lround(distance_m * kCentimetres));
  message.type = mavlink::kDistanceUnknown;
  message.orientation = mavlink::kOrientationDown;
  message.covariance =
      static_cast<std::uint8_t>(std::lround(std::clamp(variance_cm2, 1.0, kUnknownCovariance)));
  return message;
}

mavlink::FollowTarget FollowTargetOf(const TargetState& report, AutopilotKind kind,
                                     const GlobalPosition& origin, std::uint64_t boot_ms) {
  constexpr std::uint8_t kHasPosition = 1;
  constexpr std::uint8_t kHasVelocity = 2;
  const GlobalPosition place = GlobalFromLocal(kind, origin, report.position_in_world);
  const Eigen::Vector3d velocity = NedFromEnu(report.velocity_in_world);
  mavlink::FollowTarget message;
  message.timestamp = boot_ms;
  message.est_capabilities = kHasPosition | kHasVelocity;
  message.lat = place.latitude_e7;
  message.lon = place.longitude_e7;
  message.alt = ToFloat(place.altitude_m);
  for (int i = 0; i < 3; ++i) message.vel[i] = ToFloat(velocity[i]);
  message.attitude_q = ToWire(NedFromTarget(report));
  const Eigen::Vector3d variances = report.covariance.diagonal();
  message.position_cov = {ToFloat(variances.y()), ToFloat(variances.x()), ToFloat(variances.z())};
  return message;
}

bool SendTarget(LinkProfile profile, const TargetMessageOptions& options, const TargetState& report,
                const Autopilot& autopilot, Time now, Connection* connection) {
  constexpr std::uint64_t kUsPerMs = 1000;
  const bool is_vte = profile == LinkProfile::kPx4Vte;
  const Time time = is_vte ? std::min(report.time, now) : report.time;
  const std::optional<std::uint64_t> stamp_us = StampOf(autopilot, time);
  const std::uint64_t boot_ms = stamp_us.value_or(0) / kUsPerMs;
  if (options.sends_distance) {
    const auto distance =
        DistanceSensorOf(report, options.max_distance_m, static_cast<std::uint32_t>(boot_ms));
    if (distance) connection->Send(*distance);
  }
  if (options.sends_follow_target && autopilot.origin()) {
    connection->Send(FollowTargetOf(report, autopilot.kind(), *autopilot.origin(), boot_ms));
  }
  if (is_vte) return stamp_us && connection->Send(TargetRelativeForPx4(report, *stamp_us));
  return connection->Send(profile == LinkProfile::kPx4
                              ? LandingTargetForPx4(report, stamp_us.value_or(0))
                              : LandingTargetForArduPilot(report, stamp_us.value_or(0)));
}

}  // namespace kestrel
