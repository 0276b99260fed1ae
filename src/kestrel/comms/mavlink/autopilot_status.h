// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/comms/mavlink/global_position.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/packet.h"
#include "kestrel/comms/mavlink/time_sync.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

enum class LandedState { kUnknown, kOnGround, kInAir, kTakingOff, kLanding };
const char* ToString(LandedState state);  // "unknown", "on ground", "in air", ...
// False during the take-off, which belongs to the autopilot.
constexpr bool IsInFlight(LandedState state) {
  return state == LandedState::kInAir || state == LandedState::kLanding;
}

struct AutopilotVersion {
  int major = 0;
  int minor = 0;
  int patch = 0;
};

// Distance to the ground below, measured by the autopilot's own sensor.
struct AutopilotRange {
  Time time;
  double distance_m;
};

// A value is nothing when the autopilot does not measure it.
struct AutopilotBattery {
  std::optional<double> voltage_v;
  std::optional<double> current_a;
  std::optional<double> remaining;  // 0 to 1
};

// The autopilot's first GNSS receiver.
struct AutopilotGnss {
  Time received;
  int fix = 0;  // GPS_FIX_TYPE: 2: 2-D, 3: 3-D, 4: DGPS, 5 and 6: RTK; less: none
  std::optional<int> satellites;
};

// The autopilot's judgement of its own estimate.
struct EstimatorHealth {
  Time received;
  std::uint16_t flags = 0;  // ESTIMATOR_STATUS_FLAGS, or EKF_STATUS_FLAGS of ArduPilot
  bool is_good = false;     // attitude, velocity and position are known, and it trusts its GNSS
};

// Reports of an autopilot about itself, which it sends rarely, by itself or on request.
class AutopilotStatus {
 public:
  // Takes any of its messages; ignores others than those below.
  void Handle(const mavlink::Packet& packet, const TimeSync& clock, Time received);

  // The autopilot has restarted.
  void Reset() { *this = {}; }

  const std::optional<AutopilotVersion>& version() const { return version_; }
  LandedState landed() const { return landed_; }
  const std::optional<AutopilotRange>& range() const { return range_; }
  const std::optional<GlobalPosition>& origin() const { return origin_; }  // local frame
  const std::optional<GlobalPosition>& home() const { return home_; }
  // Altitude of height 0 of the local frame, m above mean sea level; PX4 reports it on request.
  std::optional<double> frame_altitude_m() const { return frame_altitude_m_; }
  const std::optional<AutopilotBattery>& battery() const { return battery_; }
  const std::optional<AutopilotGnss>& gnss() const { return gnss_; }
  const std::optional<EstimatorHealth>& estimator() const { return estimator_; }
  // True when a pilot can take over by his sticks (pilot_sticks.h).
  bool HasPilot(Time now) const;

 private:
  void HandleSystem(const mavlink::SysStatus& message);
  void HandleGnss(const mavlink::GpsRawInt& message, Time received);
  void HandleAltitude(const mavlink::Altitude& message);
  void HandleRange(const mavlink::DistanceSensor& message, const TimeSync& clock);

  std::optional<AutopilotVersion> version_;
  LandedState landed_ = LandedState::kUnknown;
  std::optional<AutopilotRange> range_;
  std::optional<GlobalPosition> origin_;
  std::optional<GlobalPosition> home_;
  std::optional<double> frame_altitude_m_;
  std::optional<AutopilotBattery> battery_;
  std::optional<AutopilotGnss> gnss_;
  std::optional<EstimatorHealth> estimator_;
  bool is_receiving_ = false;
  std::optional<Time> throttle_centred_;  // when it was last
};

// Returns "the autopilot is in a failsafe (mode RTL)".
std::string FailsafeInWords(AutopilotKind kind, std::uint32_t custom_mode);

// Returns the nanoseconds of a time in truncated milliseconds: half of one is added for the mean
// loss.
std::int64_t NanosecondsOfBoot(std::uint32_t boot_ms);

}  // namespace kestrel
