// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/message_streams.h"

#include <algorithm>
#include <cmath>

#include "kestrel/comms/mavlink/camera_messages.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/messages.h"

namespace kestrel {
namespace {

struct DefaultRate {
  std::uint32_t id;
  double ardupilot_hz;
  double px4_hz;
};

constexpr DefaultRate kDefaultRates[] = {
    {mavlink::Heartbeat::kId, 1, 1},
    {mavlink::Timesync::kId, 0.1, 10},
    {mavlink::Attitude::kId, 0, 100},
    {mavlink::AttitudeQuaternion::kId, 0, 50},
    {mavlink::LocalPositionNed::kId, 0, 30},
    {mavlink::GlobalPositionInt::kId, 0, 50},
    {mavlink::ExtendedSysState::kId, 0, 5},
    {mavlink::GpsGlobalOrigin::kId, 0, 1},
    {mavlink::HomePosition::kId, 0, 0.5},
    {mavlink::SysStatus::kId, 0, 5},
    {mavlink::VfrHud::kId, 0, 0},
    {mavlink::GpsRawInt::kId, 0, 0},
};

}  // namespace

MessageStreams::MessageStreams(AutopilotFirmware firmware, bool has_gimbal, bool has_zoom,
                               bool has_range)
    : firmware_(firmware) {
  const bool is_px4 = firmware == AutopilotFirmware::kPx4;
  for (const DefaultRate& rate : kDefaultRates) {
    const double hz = is_px4 ? rate.px4_hz : rate.ardupilot_hz;
    const std::int64_t interval_us = hz > 0 ? std::llround(1e6 / hz) : 0;
    streams_.push_back({rate.id, interval_us, interval_us});
  }
  if (is_px4) {
    constexpr std::int64_t kEstimator_us = 1'000'000;
    streams_.push_back({mavlink::EstimatorStatus::kId, kEstimator_us, kEstimator_us});
    streams_.push_back({mavlink::HighresImu::kId, 0, 0});
    constexpr std::int64_t kMode_us = 500'000;
    streams_.push_back({mavlink::CurrentMode::kId, kMode_us, kMode_us});
  } else {
    streams_.push_back({mavlink::EkfStatusReport::kId, 0, 0});
    streams_.push_back({mavlink::RawImu::kId, 0, 0});
    // Only ArduPilot's simulator sends the truth.
    streams_.push_back({mavlink::SimState::kId, 0, 0});
  }
  streams_.push_back({mavlink::RcChannels::kId, 0, 0});
  if (has_range) streams_.push_back({mavlink::DistanceSensor::kId, 0, 0});
  if (has_zoom) streams_.push_back({mavlink::CameraFovStatus::kId, 0, 0});
  if (!has_gimbal) return;
  constexpr std::int64_t kPx4Attitude_us = 200'000, kPx4Status_us = 2'000'000;
  const auto add = [&](std::uint32_t id, std::int64_t px4_us) {
    const std::int64_t interval_us = is_px4 ? px4_us : 0;
    streams_.push_back({id, interval_us, interval_us});
  };
  add(mavlink::GimbalDeviceAttitudeStatus::kId, kPx4Attitude_us);
  add(mavlink::GimbalManagerStatus::kId, kPx4Status_us);
}

bool MessageStreams::Has(std::uint32_t id) const {
  return std::ranges::find(streams_, id, &Stream::id) != streams_.end();
}

std::uint8_t MessageStreams::SetInterval(std::uint32_t id, double interval_us) {
  const bool is_px4 = firmware_ == AutopilotFirmware::kPx4;
  const auto stream = std::ranges::find(streams_, id, &Stream::id);
  const bool is_fixed = is_px4 && id == mavlink::Heartbeat::kId;
  if (stream == streams_.end() || is_fixed || !std::isfinite(interval_us)) {
    return is_px4 ? mavlink::kResultFailed : mavlink::kResultDenied;
  }
  if (interval_us == 0) {
    stream->interval_us = stream->default_us;
  } else if (interval_us < 0) {
    stream->interval_us = 0;
  } else {
    constexpr double kArduPilotLeast_us = 2500;  // period of its main loop
    constexpr double kPx4Least_us = 8000;
    if (!is_px4 && interval_us < kArduPilotLeast_us) return mavlink::kResultDenied;
    const double least_us = is_px4 ? kPx4Least_us : kArduPilotLeast_us;
    constexpr double kMost_us = 1e9;
    stream->interval_us = std::llround(std::clamp(interval_us, least_us, kMost_us));
  }
  return mavlink::kResultAccepted;
}

}  // namespace kestrel
