// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/autopilot_status.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/pilot_sticks.h"

namespace kestrel {
namespace {

LandedState LandedStateOf(std::uint8_t state) {
  switch (state) {
    case mavlink::kLandedOnGround:
      return LandedState::kOnGround;
    case mavlink::kLandedInAir:
      return LandedState::kInAir;
    case mavlink::kLandedTakeoff:
      return LandedState::kTakingOff;
    case mavlink::kLandedLanding:
      return LandedState::kLanding;
    default:
      return LandedState::kUnknown;
  }
}

AutopilotVersion VersionOf(std::uint32_t number) {
  return {static_cast<int>(number >> 24), static_cast<int>(number >> 16 & 0xff),
          static_cast<int>(number >> 8 & 0xff)};
}

// True for an estimate that is good enough for flight; none of the 'bad' flags may be set.
bool IsGood(std::uint16_t flags, std::uint16_t bad) {
  constexpr std::uint16_t kNeeded =
      mavlink::kEstimatorAttitude | mavlink::kEstimatorVelocityHorizontal |
      mavlink::kEstimatorVelocityVertical | mavlink::kEstimatorPositionVertical;
  constexpr std::uint16_t kPlace =
      mavlink::kEstimatorPositionRelative | mavlink::kEstimatorPositionAbsolute;
  return (flags & kNeeded) == kNeeded && (flags & kPlace) != 0 && (flags & bad) == 0;
}

}  // namespace

const char* ToString(LandedState state) {
  switch (state) {
    case LandedState::kUnknown:
      return "unknown";
    case LandedState::kOnGround:
      return "on ground";
    case LandedState::kInAir:
      return "in air";
    case LandedState::kTakingOff:
      return "taking off";
    case LandedState::kLanding:
      return "landing";
  }
  return "";
}

std::string FailsafeInWords(AutopilotKind kind, std::uint32_t custom_mode) {
  return fmt::format("the autopilot is in a failsafe (mode {})", ModeName(kind, custom_mode));
}

std::int64_t NanosecondsOfBoot(std::uint32_t boot_ms) {
  constexpr double kNsPerMs = 1e6;
  constexpr double kHalf_ms = 0.5;
  return static_cast<std::int64_t>((boot_ms + kHalf_ms) * kNsPerMs);
}

void AutopilotStatus::Handle(const mavlink::Packet& packet, const TimeSync& clock, Time received) {
  constexpr double kMetres = 1e-3;
  if (const auto state = packet.As<mavlink::ExtendedSysState>()) {
    landed_ = LandedStateOf(state->landed_state);
  } else if (const auto range = packet.As<mavlink::DistanceSensor>()) {
    HandleRange(*range, clock);
  } else if (const auto system = packet.As<mavlink::SysStatus>()) {
    HandleSystem(*system);
    is_receiving_ = IsReceiving(*system);
  } else if (const auto channels = packet.As<mavlink::RcChannels>()) {
    throttle_centred_ = IsThrottleCentred(*channels) ? std::optional(received) : std::nullopt;
  } else if (const auto gnss = packet.As<mavlink::GpsRawInt>()) {
    HandleGnss(*gnss, received);
  } else if (const auto ekf = packet.As<mavlink::EkfStatusReport>()) {
    constexpr std::uint16_t kBad = mavlink::kEstimatorConstantPosition |
                                   mavlink::kEkfUninitialized | mavlink::kEkfGpsGlitching;
    estimator_ = {received, ekf->flags, IsGood(ekf->flags, kBad)};
  } else if (const auto status = packet.As<mavlink::EstimatorStatus>()) {
    // PX4 is in constant position mode whenever it stands on the ground.
    estimator_ = {received, status->flags, IsGood(status->flags, mavlink::kEstimatorGpsGlitch)};
  } else if (const auto origin = packet.As<mavlink::GpsGlobalOrigin>()) {
    origin_ = {origin->latitude, origin->longitude, kMetres * origin->altitude};
  } else if (const auto altitude = packet.As<mavlink::Altitude>()) {
    HandleAltitude(*altitude);
  } else if (const auto home = packet.As<mavlink::HomePosition>()) {
    home_ = {home->latitude, home->longitude, kMetres * home->altitude};
  } else if (const auto version = packet.As<mavlink::AutopilotVersion>()) {
    version_ = VersionOf(version->flight_sw_version);
  }
}

void AutopilotStatus::HandleAltitude(const mavlink::Altitude& message) {
  const double altitude_m = message.altitude_amsl - message.altitude_local;
  constexpr double kHighest_m = 1e5;
  if (std::abs(altitude_m) < kHighest_m) frame_altitude_m_ = altitude_m;
}

bool AutopilotStatus::HasPilot(Time now) const {
  constexpr double kAge_s = 2;
  return is_receiving_ && throttle_centred_ && ToSeconds(now - *throttle_centred_) < kAge_s;
}

void AutopilotStatus::HandleSystem(const mavlink::SysStatus& message) {
  AutopilotBattery battery;
  if (message.voltage_battery != std::numeric_limits<std::uint16_t>::max()) {
    battery.voltage_v = 1e-3 * message.voltage_battery;
  }
  if (message.current_battery >= 0) battery.current_a = 1e-2 * message.current_battery;
  if (message.battery_remaining >= 0) battery.remaining = 1e-2 * message.battery_remaining;
  battery_ = battery;
}

void AutopilotStatus::HandleGnss(const mavlink::GpsRawInt& message, Time received) {
  AutopilotGnss gnss{received, message.fix_type, {}};
  if (message.satellites_visible != std::numeric_limits<std::uint8_t>::max()) {
    gnss.satellites = message.satellites_visible;
  }
  gnss_ = gnss;
}

void AutopilotStatus::HandleRange(const mavlink::DistanceSensor& message, const TimeSync& clock) {
  if (message.orientation != mavlink::kOrientationDown || !clock.is_known()) return;
  if (message.current_distance < message.min_distance ||
      message.current_distance > message.max_distance) {
    return;
  }
  range_ = {clock.ToLocal(NanosecondsOfBoot(message.time_boot_ms)),
            1e-2 * message.current_distance};
}

}  // namespace kestrel
