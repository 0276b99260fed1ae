// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/comms/mavlink/connection_counters.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/guidance/guidance_phase.h"
#include "kestrel/flight/session/flight_end.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/vision/mapping/team_object.h"

namespace kestrel {

// State of the search for the target, for people.
enum class TargetPhase {
  kSearching,  // not seen yet
  kFound,      // tracked, or predicted well enough
  kLost,       // was found, and is not any more
  kContact,    // the UAV stands on it
};
const char* ToString(TargetPhase phase);  // "searching", "found", "lost", "contact"

// Parts of the limits of guidance that following the target takes; 1 is all of it.
struct LimitsInUse {
  double lean_share = 0;
  double speed_share = 0;
  double climb_share = 0;     // share of the limit of climb or descent
  std::string cannot_follow;  // why the target cannot be followed; empty: it can
};

// State of the autopilot and of what Kestrel sends to it. A value is nothing while the autopilot
// does not report it.
struct AutopilotState {
  bool is_here = false;     // its heartbeats come
  std::string waits;        // before the first one: what is waited for, and why; else empty
  bool is_landing = false;  // armed, in a mode that lands
  bool is_armed = false;
  std::string mode;  // as "LAND"; empty before its first heartbeat
  std::optional<double> battery_v;
  std::optional<double> battery_remaining;  // 0 to 1
  std::optional<int> gnss_fix;              // GPS_FIX_TYPE; 3 and more: a position with a height
  std::optional<int> satellites;
  std::optional<bool> has_good_position;  // by its own estimator
  std::optional<GuidancePhase> guidance;
  std::optional<LimitsInUse> limits;  // with guidance
  TargetPhase target = TargetPhase::kSearching;
  ConnectionCounters link;
};

// Counts of a flight recorder.
struct RecorderCounters {
  std::uint64_t images = 0;        // written
  std::uint64_t dropped = 0;       // images that are not written, see dropped.csv
  std::uint64_t bytes = 0;         // size of the written images
  std::uint64_t lost_records = 0;  // poses, exposures and packets that the recorder was too slow to
                                   // write
};

// State of a live session, beside the results of its vision. All counts are since it began.
struct FlightReport {
  std::string trouble;  // why there are no images; empty as long as they come
  CaptureCounters capture;
  LiveEventCounters events;
  int repeated_frames = 0;
  std::optional<AutopilotState> autopilot;
  std::optional<RecorderCounters> recorder;
  std::string recording;         // folder of the recording that is on; empty: none
  std::optional<FlightEnd> end;  // once the flight is over: in the last report
};

// The knowledge of the UAV's team, in this UAV's world.
struct TeamReport {
  Time time;  // when the newest frame that has contributed was taken
  std::vector<TeamObject> objects;
};

}  // namespace kestrel
