// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/link/target_profile.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kestrel/geometry/angles.h"
#include "kestrel/link/mavlink_enums.h"
#include "kestrel/link/ned.h"

namespace kestrel {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

struct NamedProfile {
  LinkProfile profile;
  const char* name;
};
constexpr std::array kProfiles = {NamedProfile{LinkProfile::kArduPilot, "ardupilot"},
                                  NamedProfile{LinkProfile::kPx4, "px4"},
                                  NamedProfile{LinkProfile::kPx4Vte, "px4-vte"}};

std::array<float, 4> Wire(const Quaterniond& q) {
  return {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()),
          static_cast<float>(q.z())};
}

template <class Message>
void SetPosition(const Vector3d& position, Message* message) {
  message->x = static_cast<float>(position.x());
  message->y = static_cast<float>(position.y());
  message->z = static_cast<float>(position.z());
}

// What the profiles of LANDING_TARGET have in common.
mavlink::LandingTarget LandingTargetAt(std::uint64_t time_us, std::uint8_t frame,
                                       const Vector3d& position) {
  mavlink::LandingTarget message;
  message.time_usec = time_us;
  message.frame = frame;
  SetPosition(position, &message);
  message.q = {1, 0, 0, 0};
  message.type = mavlink::kTargetTypeVisionFiducial;
  message.position_valid = 1;
  return message;
}

std::array<float, 3> Wire(const Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace

const char* ToString(LinkProfile profile) {
  return std::ranges::find(kProfiles, profile, &NamedProfile::profile)->name;
}

std::optional<LinkProfile> ParseLinkProfile(std::string_view name) {
  const auto* const found = std::ranges::find(
      kProfiles, name, [](const NamedProfile& p) { return std::string_view(p.name); });
  if (found == kProfiles.end()) return std::nullopt;
  return found->profile;
}

std::optional<LinkProfile> ProfileOf(AutopilotKind kind) {
  switch (kind) {
    case AutopilotKind::kArduPilot:
      return LinkProfile::kArduPilot;
    case AutopilotKind::kPx4:
      return LinkProfile::kPx4;
    default:
      return std::nullopt;
  }
}

mavlink::LandingTarget ArduPilotTarget(const TargetReport& report, std::uint64_t time_us,
                                       const Vector3d& camera_in_frd, double size_m) {
  const Vector3d position = FrdFromFlu(report.PositionInBody()) - camera_in_frd;
  mavlink::LandingTarget message = LandingTargetAt(time_us, mavlink::kFrameBodyFrd, position);
  const double distance = position.norm();
  message.distance = static_cast<float>(distance);
  // Of the image of a camera that looks down: x to the right, y backwards.
  message.angle_x = static_cast<float>(std::atan2(position.y(), position.z()));
  message.angle_y = static_cast<float>(std::atan2(-position.x(), position.z()));
  message.size_x = message.size_y = static_cast<float>(2 * std::atan2(size_m / 2, distance));
  return message;
}

mavlink::LandingTarget Px4Target(const TargetReport& report, std::uint64_t time_us) {
  mavlink::LandingTarget message =
      LandingTargetAt(time_us, mavlink::kFrameLocalNed, NedFromEnu(report.position_in_world));
  message.distance = static_cast<float>(report.PositionInBody().norm());
  return message;
}

mavlink::TargetRelative Px4VteTarget(const TargetReport& report, std::uint64_t time_us) {
  const Eigen::Matrix3d body_from_world =
      report.world_from_body.rotation.conjugate().toRotationMatrix();
  const Eigen::Matrix3d covariance =
      body_from_world * report.covariance_in_world * body_from_world.transpose();
  const Quaterniond ned_from_frd = NedFrdFromEnuFlu(report.world_from_body.rotation);
  mavlink::TargetRelative message;
  message.timestamp = time_us;
  message.frame = mavlink::kTargetFrameBodyFrd;
  SetPosition(FrdFromFlu(report.PositionInBody()), &message);
  message.pos_std = Wire(Vector3d(covariance.diagonal().cwiseMax(0).cwiseSqrt()));
  message.q_sensor = Wire(ned_from_frd);
  message.q_target = {1, 0, 0, 0};
  message.yaw_std = static_cast<float>(kPi);  // the pattern looks the same every quarter turn
  message.type = mavlink::kTargetTypeVisionFiducial;
  return message;
}

mavlink::DistanceSensor TargetDistance(const TargetReport& report, std::uint32_t time_boot_ms,
                                       double minimum_m, double maximum_m) {
  const auto centimetres = [](double metres) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(100 * metres, 0.0, 65535.0)));
  };
  mavlink::DistanceSensor message;
  message.time_boot_ms = time_boot_ms;
  message.min_distance = centimetres(minimum_m);
  message.max_distance = centimetres(maximum_m);
  message.current_distance =
      centimetres(report.world_from_body.translation.z() - report.position_in_world.z());
  message.type = mavlink::kDistanceUnknown;
  message.orientation = mavlink::kOrientationDown;
  const double sigma_cm = 100 * std::sqrt(std::max(report.covariance_in_world(2, 2), 0.0));
  message.covariance = static_cast<std::uint8_t>(std::clamp(sigma_cm * sigma_cm, 1.0, 254.0));
  return message;
}

mavlink::FollowTarget TargetToFollow(const TargetReport& report, AutopilotKind kind,
                                     const GlobalPosition& origin, std::uint32_t time_boot_ms) {
  constexpr std::uint8_t kHasPosition = 1, kHasVelocity = 2;
  const GlobalPosition place = GlobalFromLocal(kind, origin, report.position_in_world);
  mavlink::FollowTarget message;
  message.timestamp = time_boot_ms;
  message.est_capabilities = kHasPosition | kHasVelocity;
  message.lat = place.latitude_e7;
  message.lon = place.longitude_e7;
  message.alt = static_cast<float>(place.altitude_m);
  message.vel = Wire(NedFromEnu(report.velocity_in_world));
  message.attitude_q = {1, 0, 0, 0};
  message.position_cov = Wire(NedFromEnu(report.covariance_in_world.diagonal()).cwiseAbs());
  return message;
}

}  // namespace kestrel
