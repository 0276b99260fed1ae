// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/comms/mavlink/connection_counters.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/guidance/guidance_phase.h"
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

// State of the autopilot and of what Kestrel sends to it.
struct AutopilotState {
  bool is_here = false;     // its heartbeats come
  bool is_landing = false;  // armed, in a mode that lands
  std::optional<GuidancePhase> guidance;
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
};

// The end of a flight.
enum class FlightEnd {
  kStopped,      // by the user
  kLanded,       // disarmed after it had flown
  kSourceEnded,  // a recording, to its end
  kFailed,       // camera or autopilot did not come back
};

// The knowledge of the UAV's team, in this UAV's world.
struct TeamReport {
  Time time;  // of the newest frame that has contributed
  std::vector<TeamObject> objects;
};

}  // namespace kestrel
