// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/flight_end.h"

#include <fmt/format.h>

#include "kestrel/core/base/fixed.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

const char* KindOfOffset(const FlightEnd& end) {
  if (!end.offset_m) return "";
  return end.has_true_offset ? "true" : "estimated";
}

std::string OnPatternInWords(const FlightEnd& end) {
  if (!end.offset_m) return "landed on the pattern";
  const std::string estimate =
      end.estimated_m ? fmt::format(", {:.2f} m estimated", *end.estimated_m) : "";
  return fmt::format("landed {:.2f} m from the centre ({}){}", *end.offset_m, KindOfOffset(end),
                     estimate);
}

// Place of the landing, for an end at which the UAV may be anywhere.
std::string PlaceOf(const FlightEnd& end) {
  return end.offset_m
             ? fmt::format("down {:.1f} m from the pattern ({})", *end.offset_m, KindOfOffset(end))
             : "down, and not known where";
}

std::string WithReason(const std::string& words, const std::string& reason) {
  return reason.empty() ? words : words + ": " + reason;
}

std::string HeadingInWords(const FlightEnd& end) {
  return end.heading_error
             ? fmt::format(", heading off by {} degrees", Fixed(Degrees(*end.heading_error), 1))
             : "";
}

}  // namespace

const char* ToString(FlightOutcome outcome) {
  switch (outcome) {
    case FlightOutcome::kStopped:
      return "stopped";
    case FlightOutcome::kSourceEnded:
      return "source ended";
    case FlightOutcome::kLanded:
      return "landed";
    case FlightOutcome::kOnPattern:
      return "on pattern";
    case FlightOutcome::kBesidePattern:
      return "beside pattern";
    case FlightOutcome::kDownSomewhere:
      return "down somewhere";
    case FlightOutcome::kGaveUp:
      return "gave up";
    case FlightOutcome::kNotLanded:
      return "not landed";
    case FlightOutcome::kRestarted:
      return "restarted";
    case FlightOutcome::kLinkLost:
      return "link lost";
  }
  return "";
}

std::string InWords(const FlightEnd& end) {
  switch (end.outcome) {
    case FlightOutcome::kStopped:
      return "ended by the user";
    case FlightOutcome::kSourceEnded:
      return "the source has ended";
    case FlightOutcome::kLanded:
      return "landed";
    case FlightOutcome::kOnPattern:
      return OnPatternInWords(end) + HeadingInWords(end) +
             (end.reason.empty() ? "" : ", " + end.reason);
    case FlightOutcome::kBesidePattern:
      return fmt::format("landed {:.1f} m beside the pattern ({})", end.offset_m.value_or(0),
                         KindOfOffset(end));
    case FlightOutcome::kDownSomewhere:
      return WithReason("down, and not known where", end.reason);
    case FlightOutcome::kGaveUp:
      return fmt::format("guidance gave up ({}); {}", end.reason, PlaceOf(end));
    case FlightOutcome::kNotLanded:
      return WithReason("not landed", end.reason);
    case FlightOutcome::kRestarted:
      return "the autopilot restarted in flight";
    case FlightOutcome::kLinkLost:
      return WithReason("link lost", end.reason);
  }
  return "";
}

std::string FlightEndCsv(const FlightEnd& end) {
  return fmt::format(
      "end,offset_m,words,heading_error_deg,offset_is\n{},{},\"{}\",{},{}\n", ToString(end.outcome),
      end.offset_m ? fmt::format("{:.4f}", *end.offset_m) : "", InWords(end),
      end.heading_error ? Fixed(Degrees(*end.heading_error), 2) : "", KindOfOffset(end));
}

int ExitStatus(const FlightEnd& end) {
  constexpr int kDone = 0;
  constexpr int kFailed = 3;
  constexpr int kNotOnPattern = 4;
  switch (end.outcome) {
    case FlightOutcome::kStopped:
    case FlightOutcome::kSourceEnded:
    case FlightOutcome::kLanded:
    case FlightOutcome::kOnPattern:
      return kDone;
    case FlightOutcome::kBesidePattern:
    case FlightOutcome::kDownSomewhere:
    case FlightOutcome::kGaveUp:
      return kNotOnPattern;
    case FlightOutcome::kNotLanded:
    case FlightOutcome::kRestarted:
    case FlightOutcome::kLinkLost:
      return kFailed;
  }
  return kFailed;
}

}  // namespace kestrel
