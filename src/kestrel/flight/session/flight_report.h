// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/guidance/landing_guidance.h"
#include "kestrel/flight/session/live_events.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/vision/mapping/team_object.h"

namespace kestrel {

// What is known of the target's whereabouts, for people.
enum class TargetPhase {
  kSearching,  // not seen yet
  kFound,      // tracked, or predicted well enough
  kLost,       // was found, and is not any more
  kContact,    // the UAV stands on it
};
const char* ToString(TargetPhase phase);  // "searching", "found", "lost", "contact"

// State of the autopilot and of what it is told.
struct AutopilotState {
  bool is_here = false;     // its heartbeats come
  bool is_landing = false;  // armed, in a mode that lands
  std::optional<GuidancePhase> guidance;
  TargetPhase target = TargetPhase::kSearching;
  ConnectionCounters link;
};

// What a flight recorder has written.
struct RecorderCounters {
  std::uint64_t images = 0;        // written
  std::uint64_t dropped = 0;       // images that are not, see dropped.csv
  std::uint64_t bytes = 0;         // of the images that are written
  std::uint64_t lost_records = 0;  // poses, exposures and packets for which there was no time
};

// State of a live session, beside what its vision sees; all counts are since it began.
struct FlightReport {
  std::string trouble;  // why there are no images; empty as long as they come
  CaptureCounters capture;
  LiveEvents::Counters events;
  int repeated_frames = 0;
  std::optional<AutopilotState> autopilot;
  std::optional<RecorderCounters> recorder;
};

// What the UAV's team knows, in this UAV's world.
struct TeamReport {
  Time time;  // of the newest frame that is in it
  std::vector<TeamObject> objects;
};

}  // namespace kestrel
