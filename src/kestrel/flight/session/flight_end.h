// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace kestrel {

enum class FlightOutcome {
  kStopped,        // by the user
  kSourceEnded,    // a recording, to its end
  kLanded,         // disarmed after it had flown, in a flight that looks for no pattern
  kOnPattern,      // landed on the pattern
  kBesidePattern,  // landed, surely not on it
  kDownSomewhere,  // landed, and not known where relative to the pattern
  kGaveUp,         // guidance had given up, and it came down, not surely on the pattern
  kNotLanded,      // camera or results failed for good in flight
  kRestarted,      // the autopilot restarted in flight
  kLinkLost,       // the autopilot did not come back
};
// "stopped", "source ended", "landed", "on pattern", "beside pattern", "down somewhere", "gave up",
// "not landed", "restarted", "link lost"
const char* ToString(FlightOutcome outcome);

// The end of a flight.
struct FlightEnd {
  FlightOutcome outcome = FlightOutcome::kStopped;
  // Horizontal distance of the feet from the pattern's centre at touch-down, m; nothing: not known.
  // The one number that all outputs give.
  std::optional<double> offset_m = {};
  std::string reason = {};  // why it is not known, how it is known, or what failed
  // Angle of the nose off guidance.touchdown_heading at touch-down, rad, counter-clockwise from
  // above; nothing: any heading would do, or the pad's is not known.
  std::optional<double> heading_error = {};
  bool has_true_offset = false;  // the offset is a simulation's truth; false: Kestrel's estimate
  std::optional<double> estimated_m = {};  // beside the truth, Kestrel's estimate of the offset
};

// Returns the end for people, as "landed 0.05 m from the centre (estimated)".
// All outputs use these words.
std::string InWords(const FlightEnd& end);

// Returns the end as a table with a header and one row: its name, the offset (empty: not known),
// the words, the error of the heading in degrees (empty: not known), and what the offset is:
// "true", "estimated" or empty.
std::string FlightEndCsv(const FlightEnd& end);

// Returns the exit status of a program whose flight ended so: 0 on the pattern, or where nobody
// wanted to land on one; 4 down, but not known to be on it; 3 when something failed for good.
int ExitStatus(const FlightEnd& end);

}  // namespace kestrel
