// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/camera_messages.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/packet.h"
#include "kestrel/core/base/limits.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"

namespace kestrel {

// All messages that a simulated autopilot sends.
using AutopilotMessage = std::variant<
    mavlink::Heartbeat, mavlink::Attitude, mavlink::AttitudeQuaternion, mavlink::LocalPositionNed,
    mavlink::GlobalPositionInt, mavlink::GpsGlobalOrigin, mavlink::HomePosition, mavlink::SimState,
    mavlink::ExtendedSysState, mavlink::Timesync, mavlink::Statustext, mavlink::CurrentMode,
    mavlink::AutopilotVersion, mavlink::ParamValue, mavlink::CommandAck, mavlink::SysStatus,
    mavlink::EkfStatusReport, mavlink::EstimatorStatus, mavlink::RcChannels, mavlink::RawImu,
    mavlink::HighresImu, mavlink::GimbalManagerInformation, mavlink::GimbalManagerStatus,
    mavlink::GimbalDeviceAttitudeStatus, mavlink::CameraFovStatus, mavlink::VfrHud,
    mavlink::GpsRawInt, mavlink::DistanceSensor>;

// All messages that it handles.
using CompanionMessage =
    std::variant<mavlink::Heartbeat, mavlink::CommandLong, mavlink::SetMode, mavlink::Timesync,
                 mavlink::LandingTarget, mavlink::TargetRelative, mavlink::ParamRequestRead,
                 mavlink::ParamRequestList, mavlink::ParamSet, mavlink::SetAttitudeTarget,
                 mavlink::SetPositionTargetLocalNed, mavlink::GimbalManagerSetPitchyaw,
                 mavlink::SetGpsGlobalOrigin, mavlink::Odometry>;

// Returns the message of a packet, if the autopilot handles it.
std::optional<CompanionMessage> CompanionMessageOf(const mavlink::Packet& packet);

// Position of the local frame's origin on the Earth.
struct GlobalOrigin {
  double latitude_deg = 47.397742;
  double longitude_deg = 8.545594;
  double altitude_m = 488;

  static void Visit(auto& self, auto&& visit) {
    visit("latitude_deg", self.latitude_deg, Range{-80, 80}, "latitude of the origin");
    visit("longitude_deg", self.longitude_deg, Range{-180, 180}, "longitude of the origin");
    visit("altitude_m", self.altitude_m, Range{-500, 9000}, "height of the origin above the sea");
  }
};

// Messages of a pose (ENU, FLU, with motion) at 'boot_ms' on the autopilot's clock.
mavlink::Attitude AttitudeOf(const PoseSample& pose, std::uint32_t boot_ms);
mavlink::AttitudeQuaternion AttitudeQuaternionOf(const PoseSample& pose, std::uint32_t boot_ms);
mavlink::LocalPositionNed LocalPositionOf(const PoseSample& pose, std::uint32_t boot_ms);
mavlink::GlobalPositionInt GlobalPositionOf(const PoseSample& pose, const GlobalOrigin& origin,
                                            std::uint32_t boot_ms);
// Messages of an acceleration that the accelerometer measures (FLU, m/s^2).
mavlink::RawImu RawImuOf(const Eigen::Vector3d& acceleration, std::int64_t boot_us);
mavlink::HighresImu HighresImuOf(const Eigen::Vector3d& acceleration, std::int64_t boot_us);
mavlink::SimState SimStateOf(const PoseSample& pose, const GlobalOrigin& origin);
mavlink::HomePosition HomePositionOf(const GlobalOrigin& origin, double leg_m,
                                     std::int64_t boot_us);
mavlink::GpsGlobalOrigin GlobalOriginOf(const GlobalOrigin& origin, std::int64_t boot_us);

// State of battery and sensors, with a low battery or a good one.
mavlink::SysStatus SysStatusOf(bool has_low_battery, bool has_receiver);

// A range finder that looks down, from 0.1 to 40 m.
mavlink::DistanceSensor RangeOf(double distance_m, std::uint32_t boot_ms);

// Flags of EKF_STATUS_REPORT and of ESTIMATOR_STATUS, with and without a position.
std::uint16_t EstimatorFlags(bool has_position);

// PX4 puts the bits of an integer into the float, ArduPilot its value.
mavlink::ParamValue ParamValueOf(const AutopilotParameters& parameters, std::size_t index,
                                 AutopilotFirmware firmware);
double ValueOf(const mavlink::ParamSet& set, AutopilotFirmware firmware);

// Convert between text and a character field, which has no final zero when it is full.
template <std::size_t kSize>
std::array<char, kSize> CharsOf(std::string_view text) {
  std::array<char, kSize> chars{};
  text.copy(chars.data(), kSize);
  return chars;
}
template <std::size_t kSize>
std::string_view TextOf(const std::array<char, kSize>& chars) {
  const std::string_view text(chars.data(), kSize);
  return text.substr(0, text.find('\0'));
}

}  // namespace kestrel
