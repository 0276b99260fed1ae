// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/autopilot_messages.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <Eigen/Geometry>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/ned.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

struct EulerAngles {
  float roll;
  float pitch;
  float yaw;
};

// Angles of ned_from_frd, as in ATTITUDE.
EulerAngles EulerAnglesOf(const Eigen::Quaterniond& q) {
  const double sine = std::clamp(2 * (q.w() * q.y() - q.z() * q.x()), -1.0, 1.0);
  return {static_cast<float>(std::atan2(2 * (q.w() * q.x() + q.y() * q.z()),
                                        1 - 2 * (q.x() * q.x() + q.y() * q.y()))),
          static_cast<float>(std::asin(sine)),
          static_cast<float>(std::atan2(2 * (q.w() * q.z() + q.x() * q.y()),
                                        1 - 2 * (q.y() * q.y() + q.z() * q.z())))};
}

struct GeoPoint {
  std::int32_t latitude;  // 1e-7 deg
  std::int32_t longitude;
  double altitude_m;
};

GeoPoint GeoPointAt(const Vector3d& in_world, const GlobalOrigin& origin) {
  constexpr double kEarthRadius_m = 6378137;
  const double latitude_deg = origin.latitude_deg + Degrees(in_world.y() / kEarthRadius_m);
  const double longitude_deg =
      origin.longitude_deg +
      Degrees(in_world.x() / (kEarthRadius_m * std::cos(Radians(origin.latitude_deg))));
  return {static_cast<std::int32_t>(std::lround(1e7 * latitude_deg)),
          static_cast<std::int32_t>(std::lround(1e7 * longitude_deg)),
          origin.altitude_m + in_world.z()};
}

template <class Message>
bool TakeAs(const mavlink::Packet& packet, std::optional<CompanionMessage>* message) {
  if (packet.id != Message::kId) return false;
  if (const auto as = packet.As<Message>()) *message = *as;
  return true;
}

template <class... Messages>
std::optional<CompanionMessage> TakeOneOf(const mavlink::Packet& packet,
                                          const std::variant<Messages...>* /*kinds*/) {
  std::optional<CompanionMessage> message;
  (TakeAs<Messages>(packet, &message) || ...);
  return message;
}

std::int16_t Centimetres(double metres) {
  return static_cast<std::int16_t>(std::lround(100 * metres));
}

}  // namespace

std::optional<CompanionMessage> CompanionMessageOf(const mavlink::Packet& packet) {
  return TakeOneOf(packet, static_cast<const CompanionMessage*>(nullptr));
}

mavlink::Attitude AttitudeOf(const PoseSample& pose, std::uint32_t boot_ms) {
  const EulerAngles angles = EulerAnglesOf(NedFrdFromEnuFlu(pose.world_from_body.rotation));
  const Vector3d rate = FrdFromFlu(pose.motion->rate_in_body);
  return {.time_boot_ms = boot_ms,
          .roll = angles.roll,
          .pitch = angles.pitch,
          .yaw = angles.yaw,
          .rollspeed = static_cast<float>(rate.x()),
          .pitchspeed = static_cast<float>(rate.y()),
          .yawspeed = static_cast<float>(rate.z())};
}

mavlink::AttitudeQuaternion AttitudeQuaternionOf(const PoseSample& pose, std::uint32_t boot_ms) {
  const Eigen::Quaternionf q = NedFrdFromEnuFlu(pose.world_from_body.rotation).cast<float>();
  const Eigen::Vector3f rate = FrdFromFlu(pose.motion->rate_in_body).cast<float>();
  mavlink::AttitudeQuaternion message;
  message.time_boot_ms = boot_ms;
  message.q1 = q.w();
  message.q2 = q.x();
  message.q3 = q.y();
  message.q4 = q.z();
  message.rollspeed = rate.x();
  message.pitchspeed = rate.y();
  message.yawspeed = rate.z();
  return message;
}

mavlink::LocalPositionNed LocalPositionOf(const PoseSample& pose, std::uint32_t boot_ms) {
  const Eigen::Vector3f p = NedFromEnu(pose.world_from_body.translation).cast<float>();
  const Eigen::Vector3f v = NedFromEnu(pose.motion->velocity_in_world).cast<float>();
  return {.time_boot_ms = boot_ms,
          .x = p.x(),
          .y = p.y(),
          .z = p.z(),
          .vx = v.x(),
          .vy = v.y(),
          .vz = v.z()};
}

mavlink::GlobalPositionInt GlobalPositionOf(const PoseSample& pose, const GlobalOrigin& origin,
                                            std::uint32_t boot_ms) {
  const Vector3d& position = pose.world_from_body.translation;
  const GeoPoint at = GeoPointAt(position, origin);
  const Vector3d v = NedFromEnu(pose.motion->velocity_in_world);
  const double yaw = EulerAnglesOf(NedFrdFromEnuFlu(pose.world_from_body.rotation)).yaw;
  constexpr int kFullTurn_cdeg = 36000;
  const int heading = static_cast<int>(std::lround(100 * Degrees(yaw)));
  return {.time_boot_ms = boot_ms,
          .lat = at.latitude,
          .lon = at.longitude,
          .alt = static_cast<std::int32_t>(std::lround(1000 * at.altitude_m)),
          .relative_alt = static_cast<std::int32_t>(std::lround(1000 * position.z())),
          .vx = Centimetres(v.x()),
          .vy = Centimetres(v.y()),
          .vz = Centimetres(v.z()),
          .hdg = static_cast<std::uint16_t>((heading + kFullTurn_cdeg) % kFullTurn_cdeg)};
}

mavlink::RawImu RawImuOf(const Vector3d& acceleration, std::int64_t boot_us) {
  constexpr double kPerMilliG = 1000 / 9.80665;
  const Vector3d in_frd = kPerMilliG * FrdFromFlu(acceleration);
  mavlink::RawImu message;
  message.time_usec = static_cast<std::uint64_t>(boot_us);
  message.xacc = static_cast<std::int16_t>(std::lround(in_frd.x()));
  message.yacc = static_cast<std::int16_t>(std::lround(in_frd.y()));
  message.zacc = static_cast<std::int16_t>(std::lround(in_frd.z()));
  return message;
}

mavlink::HighresImu HighresImuOf(const Vector3d& acceleration, std::int64_t boot_us) {
  const Eigen::Vector3f in_frd = FrdFromFlu(acceleration).cast<float>();
  mavlink::HighresImu message;
  message.time_usec = static_cast<std::uint64_t>(boot_us);
  message.xacc = in_frd.x();
  message.yacc = in_frd.y();
  message.zacc = in_frd.z();
  return message;
}

mavlink::SimState SimStateOf(const PoseSample& pose, const GlobalOrigin& origin) {
  const Eigen::Quaterniond rotation = NedFrdFromEnuFlu(pose.world_from_body.rotation);
  const EulerAngles angles = EulerAnglesOf(rotation);
  const Eigen::Quaternionf q = rotation.cast<float>();
  const Eigen::Vector3f rate = FrdFromFlu(pose.motion->rate_in_body).cast<float>();
  const Eigen::Vector3f v = NedFromEnu(pose.motion->velocity_in_world).cast<float>();
  const GeoPoint at = GeoPointAt(pose.world_from_body.translation, origin);
  mavlink::SimState state;
  state.q1 = q.w();
  state.q2 = q.x();
  state.q3 = q.y();
  state.q4 = q.z();
  state.roll = angles.roll;
  state.pitch = angles.pitch;
  state.yaw = angles.yaw;
  state.xgyro = rate.x();
  state.ygyro = rate.y();
  state.zgyro = rate.z();
  // ArduPilot's wrong scale: 1e-7 degrees, where the message has degrees.
  state.lat = static_cast<float>(at.latitude);
  state.lon = static_cast<float>(at.longitude);
  state.alt = static_cast<float>(at.altitude_m);
  state.vn = v.x();
  state.ve = v.y();
  state.vd = v.z();
  state.lat_int = at.latitude;
  state.lon_int = at.longitude;
  return state;
}

mavlink::GpsGlobalOrigin GlobalOriginOf(const GlobalOrigin& origin, std::int64_t boot_us) {
  const GeoPoint at = GeoPointAt(Vector3d::Zero(), origin);
  return {.latitude = at.latitude,
          .longitude = at.longitude,
          .altitude = static_cast<std::int32_t>(std::lround(1000 * at.altitude_m)),
          .time_usec = static_cast<std::uint64_t>(boot_us)};
}

// Home is the body's place when it stands at the origin. Height 0 of the simulated local frame is
// the ground, of a real one the body.
mavlink::HomePosition HomePositionOf(const GlobalOrigin& origin, double leg_m,
                                     std::int64_t boot_us) {
  const GeoPoint at = GeoPointAt({0, 0, leg_m}, origin);
  mavlink::HomePosition message;
  message.latitude = at.latitude;
  message.longitude = at.longitude;
  message.altitude = static_cast<std::int32_t>(std::lround(1000 * at.altitude_m));
  message.q = {1, 0, 0, 0};
  message.time_usec = static_cast<std::uint64_t>(boot_us);
  return message;
}

mavlink::SysStatus SysStatusOf(bool has_low_battery, bool has_receiver) {
  // Gyros, accelerometers, compass, barometer, GNSS, attitude and position control, motors.
  constexpr std::uint32_t kSensors = 0x0001 | 0x0002 | 0x0004 | 0x0008 | 0x0020 | 0x4000 | 0x8000;
  const std::uint32_t sensors = kSensors | (has_receiver ? mavlink::kSensorReceiver : 0);
  mavlink::SysStatus message;
  message.onboard_control_sensors_present = sensors;
  message.onboard_control_sensors_enabled = sensors;
  message.onboard_control_sensors_health = sensors;
  message.voltage_battery = has_low_battery ? 13600 : 15400;
  message.current_battery = 1800;
  message.battery_remaining = has_low_battery ? 10 : 80;
  return message;
}

mavlink::DistanceSensor RangeOf(double distance_m, std::uint32_t boot_ms) {
  constexpr int kLeast_cm = 10, kMost_cm = 4000;
  const double reported_cm = std::clamp(100 * distance_m, 0.0, kMost_cm + 1.0);
  mavlink::DistanceSensor message;
  message.time_boot_ms = boot_ms;
  message.min_distance = kLeast_cm;
  message.max_distance = kMost_cm;
  message.current_distance = static_cast<std::uint16_t>(std::lround(reported_cm));
  message.orientation = mavlink::kOrientationDown;
  return message;
}

std::uint16_t EstimatorFlags(bool has_position) {
  constexpr std::uint16_t kPredicted = 256 | 512;
  constexpr std::uint16_t kWithout = mavlink::kEstimatorAttitude |
                                     mavlink::kEstimatorVelocityVertical |
                                     mavlink::kEstimatorPositionVertical;
  if (!has_position) return kWithout | mavlink::kEstimatorConstantPosition;
  return kWithout | mavlink::kEstimatorVelocityHorizontal | mavlink::kEstimatorPositionRelative |
         mavlink::kEstimatorPositionAbsolute | kPredicted;
}

mavlink::ParamValue ParamValueOf(const AutopilotParameters& parameters, std::size_t index,
                                 AutopilotFirmware firmware) {
  const AutopilotParameter& parameter = parameters.at(index);
  const bool as_bits = parameter.is_integer && firmware == AutopilotFirmware::kPx4;
  mavlink::ParamValue message;
  message.param_id = CharsOf<16>(parameter.name);
  message.param_value = as_bits ? std::bit_cast<float>(static_cast<std::int32_t>(parameter.value))
                                : static_cast<float>(parameter.value);
  message.param_type = parameter.is_integer ? mavlink::kParamInt32 : mavlink::kParamReal32;
  message.param_count = static_cast<std::uint16_t>(parameters.size());
  message.param_index = static_cast<std::uint16_t>(index);
  return message;
}

double ValueOf(const mavlink::ParamSet& set, AutopilotFirmware firmware) {
  const bool as_bits =
      set.param_type == mavlink::kParamInt32 && firmware == AutopilotFirmware::kPx4;
  return as_bits ? std::bit_cast<std::int32_t>(set.param_value) : set.param_value;
}

}  // namespace kestrel
