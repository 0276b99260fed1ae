// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/link_checks.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/flight/doctor/statistics.h"

namespace kestrel {
namespace {

bool IsSerial(const LinkObservations& link) { return IsSerial(link.scheme); }

double ShareOf(std::uint64_t part, std::uint64_t rest) {
  return static_cast<double>(part) / std::max(1.0, static_cast<double>(part + rest));
}

// Returns the finding for a line on which nothing could be read.
Finding SilentLine(const std::string& check, const LinkObservations& link) {
  constexpr std::uint64_t kGarbage = 50;  // bytes
  const ConnectionCounters& counters = link.counters;
  const std::uint64_t rubbish = counters.garbage_bytes + counters.bad_checksums;
  if (rubbish > kGarbage) {
    return Wrong(
        check, link.silence,
        IsSerial(link)
            ? fmt::format("wrong baud, most likely: {} here; ArduPilot SERIALn_BAUD (921 = "
                          "921600, 57 = 57600), PX4 SER_TEL2_BAUD",
                          link.baud)
            : "who sends there does not speak MAVLink");
  }
  return Wrong(
      check, link.silence,
      IsSerial(link)
          ? "TX to RX crossed, ground joined, the right port; ArduPilot SERIALn_PROTOCOL 2, "
            "PX4 MAV_1_CONFIG 102 (TELEM2), MAV_1_MODE 2; no login console on that line"
          : "address and port; does the autopilot send there (udpin waits to be spoken "
            "to), and does no firewall drop it?");
}

Finding CheckStream(const std::string& check, int messages, double listened_s, double age_s,
                    double requested_hz, const std::string& missing_advice) {
  constexpr double kEnough = 0.6;  // share of the requested rate
  constexpr double kLeast_hz = 10;
  constexpr double kOld_s = 1;
  const double rate_hz = listened_s > 0 ? messages / listened_s : 0;
  const std::string measured =
      fmt::format("{:.0f} of {:.0f} requested per second", rate_hz, requested_hz);
  if (messages == 0) return Wrong(check, "none came", missing_advice);
  if (age_s > kOld_s) {
    return Wrong(check, fmt::format("the last one came {:.1f} s ago", age_s), missing_advice);
  }
  const std::string advice =
      "a faster line (921600 baud), no other ground station that asks for less on this port, "
      "MAVn_OPTIONS without \"ignore stream requests\"";
  if (rate_hz < std::min(kLeast_hz, kEnough * requested_hz)) return Wrong(check, measured, advice);
  if (rate_hz < kEnough * requested_hz) return Doubtful(check, measured, advice);
  return Good(check, measured);
}

}  // namespace

LinkProfile ProfileOf(const DoctorObservations& observations) {
  return observations.use.profile.value_or(ProfileFor(observations.link.kind));
}

Finding CheckLine(const LinkObservations& link) {
  constexpr double kLost = 0.05;
  constexpr double kMuchLost = 0.3;
  const std::string check = "line";
  if (!link.isrequested) {
    return NotChecked(check, "no autopilot was named", "--autopilot URL");
  }
  if (!link.open_error.empty()) {
    return Wrong(check, link.open_error,
                 "the line has to open first: kestrel fly --help shows how lines are written");
  }
  const ConnectionCounters& counters = link.counters;
  if (counters.received == 0 && counters.unsigned_packets + counters.forged_packets > 0) {
    return Good(check, fmt::format("{} packets, none with a good signature",
                                   counters.unsigned_packets + counters.forged_packets));
  }
  if (counters.received == 0) return SilentLine(check, link);
  const double lost = ShareOf(link.lost_packets + counters.bad_checksums, counters.received);
  const double unsent = ShareOf(counters.unsent, counters.sent);
  const std::string measured =
      fmt::format("{} packets; {:.1f} % lost, {} damaged, {} bytes of garbage; {:.1f} % not sent",
                  counters.received, kPercent * lost, counters.bad_checksums,
                  counters.garbage_bytes, kPercent * unsent);
  const std::string advice = IsSerial(link)
                                 ? "shorter or shielded wires, ground joined, flow control "
                                   "(serial_flowcontrol://), fewer messages"
                                 : "a better radio link, or a wire";
  const double worst = std::max(lost, unsent);
  if (worst > kMuchLost) return Wrong(check, measured, advice);
  if (worst > kLost) return Doubtful(check, measured, advice);
  return Good(check, measured);
}

Finding CheckSigning(const LinkObservations& link) {
  const std::string check = "signing";
  const ConnectionCounters& counters = link.counters;
  if (!link.is_signed) {
    if (!link.hears_signed) return Good(check, "neither side signs");
    return Wrong(check, "the autopilot signs, this side does not: it ignores what it receives",
                 "--signing-key FILE with the autopilot's key");
  }
  const std::string refused =
      fmt::format("{} unsigned, {} forged, {} replayed packets refused", counters.unsigned_packets,
                  counters.forged_packets, counters.replayed_packets);
  if (link.is_heard) return Good(check, "signed; " + refused);
  if (counters.unsigned_packets > 0) {
    return Wrong(check, refused,
                 "the autopilot does not sign: give it the key (SETUP_SIGNING by the ground "
                 "station), or leave --signing-key out");
  }
  if (counters.forged_packets + counters.replayed_packets > 0) {
    return Wrong(check, refused,
                 "another key, or a clock that is more than a minute off (date; a computer without "
                 "a battery clock)");
  }
  return NotChecked(check, "nothing was heard");
}

Finding CheckHeartbeat(const LinkObservations& link) {
  const std::string check = "heartbeat";
  if (!link.is_heard) {
    return Wrong(check,
                 fmt::format("none of an autopilot, {} packets of others", link.counters.received),
                 "see the line above; is the autopilot started, and its port set to MAVLink 2?");
  }
  const std::string measured =
      fmt::format("{}, {} heartbeats, mode {}{}", ToString(link.kind), link.heartbeats, link.mode,
                  link.is_armed ? ", armed" : "");
  if (link.restarts > 0) {
    return Wrong(check, measured + fmt::format("; started anew {} times", link.restarts),
                 "its power supply");
  }
  return Good(check, measured);
}

Finding CheckVersion(const LinkObservations& link) {
  const std::string check = "version";
  if (link.kind != AutopilotKind::kArduPilot && link.kind != AutopilotKind::kPx4) {
    return Doubtful(check, ToString(link.kind), "Kestrel is tried with ArduPilot and PX4 only");
  }
  if (!link.version) return NotChecked(check, "not reported");
  const AutopilotVersion& version = *link.version;
  const bool is_ardupilot = link.kind == AutopilotKind::kArduPilot;
  constexpr int kPx4Minor = 13;
  const bool is_old = is_ardupilot
                          ? version.major < 4
                          : version.major < 1 || (version.major == 1 && version.minor < kPx4Minor);
  const std::string measured =
      fmt::format("{} {}.{}.{}", ToString(link.kind), version.major, version.minor, version.patch);
  if (!is_old) return Good(check, measured);
  return Doubtful(check, measured,
                  is_ardupilot ? "4.0 or newer: older ones know no SET_MESSAGE_INTERVAL"
                               : "1.13 or newer, which Kestrel is tried with");
}

Finding CheckVehicle(const LinkObservations& link) {
  const std::string check = "vehicle";
  if (!link.vehicle_type) return NotChecked(check, "not reported");
  const std::string measured = VehicleName(*link.vehicle_type);
  if (IsMulticopter(*link.vehicle_type)) return Good(check, measured);
  return Wrong(
      check, measured + ", no multicopter",
      "Kestrel lands multicopters; is this the right autopilot (fly.autopilot.system_id)?");
}

Finding CheckAttitudes(const LinkObservations& link, const DoctorUse& use) {
  return CheckStream("attitude", link.attitudes, link.listened_s, link.attitude_age_s,
                     use.attitude_rate_hz,
                     "the autopilot refuses requests: SR2_EXTRA1 or MAV2_EXTRA1 50 (ArduPilot), "
                     "MAV_1_MODE 2 (PX4); is its estimator started?");
}

Finding CheckPositions(const LinkObservations& link, const DoctorUse& use) {
  if (use.no_position) return NotChecked("position", "not wanted: --no-position");
  if (use.pad_position && link.positions == 0) {
    return NotChecked("position", "none before kestrel fly sends the pad's");
  }
  return CheckStream("position", link.positions, link.listened_s, link.position_age_s,
                     use.position_rate_hz,
                     "no local position: wait for GNSS and the estimator, go outdoors; then "
                     "SR2_POSITION or MAV2_POSITION 50 (ArduPilot), MAV_1_MODE 2 (PX4)");
}

Finding CheckEstimate(const LinkObservations& link, const DoctorUse& use) {
  const std::string check = "position estimate";
  if (use.no_position) return NotChecked(check, "not wanted: --no-position");
  if (use.pad_position && !link.has_good_position.value_or(false)) {
    return NotChecked(check, "none before kestrel fly sends the pad's");
  }
  if (!link.has_good_position) return NotChecked(check, "the autopilot does not report it");
  if (*link.has_good_position) return Good(check, "the autopilot trusts its own position");
  return Wrong(check, "the autopilot does not trust its own position",
               "GNSS (or another source of position), compass, and some time; without it neither "
               "precision landing nor guidance starts");
}

Finding CheckOrigin(const LinkObservations& link, const DoctorUse& use) {
  const std::string check = "origin";
  if (link.has_origin) return Good(check, "the autopilot has one");
  if (use.has_pad_origin) return Good(check, "Kestrel sets fly.pad_origin");
  if (link.kind == AutopilotKind::kPx4) return Good(check, "PX4 needs none");
  return Wrong(check,
               "the autopilot has none: no home, without which --guide refuses, and no failsafe of "
               "its estimator",
               "--set fly.pad_origin=LATITUDE,LONGITUDE, or set it at the ground station");
}

Finding CheckAutopilotClock(const LinkObservations& link) {
  constexpr double kDrift = 3e-4;
  constexpr double kSigma_s = 0.02;
  constexpr double kPpm = 1e6;
  const std::string check = "autopilot's clock";
  if (!link.knows_clock) {
    return Wrong(check, "not known", "a line in both directions: TIMESYNC is not answered");
  }
  const std::string measured = fmt::format("known to {:.1f} ms, {:+.0f} ppm",
                                           kMilliseconds * link.clock_sigma_s, kPpm * link.drift);
  if (link.clock_jumps > 0) {
    return Wrong(check, fmt::format("jumped {} times", link.clock_jumps),
                 "only one program on this line may answer TIMESYNC; a simulation must not be "
                 "paused");
  }
  if (link.is_one_way) {
    return Doubtful(check, measured + ", from one direction only",
                    "TIMESYNC is not answered: is the line to the autopilot connected, is the "
                    "firmware old?");
  }
  if (std::abs(link.drift) > kDrift || link.clock_sigma_s > kSigma_s) {
    return Doubtful(check, measured, "a line that delays less; a simulation in real time");
  }
  return Good(check, measured);
}

Finding CheckRoundTrip(const LinkObservations& link, const DoctorUse& use) {
  constexpr double kSlow_s = 0.1;
  constexpr double kTooSlow_s = 0.4;
  constexpr double kPx4Limit_s = 0.01;
  const std::string check = "round trip";
  if (!link.knows_clock || link.is_one_way) return NotChecked(check, "TIMESYNC is not answered");
  const std::string measured = fmt::format("{:.1f} ms", kMilliseconds * link.round_trip_s);
  const std::string advice = "a faster line, less on it; a wire instead of a radio";
  if (link.round_trip_s > kTooSlow_s) return Wrong(check, measured, advice);
  if (link.round_trip_s > kSlow_s) return Doubtful(check, measured, advice);
  if (use.profile == LinkProfile::kPx4Vte && link.round_trip_s > kPx4Limit_s) {
    return Doubtful(check, measured, "PX4 trusts a clock only by round trips below 10 ms");
  }
  return Good(check, measured);
}

Finding CheckLinkEvents(const LinkObservations& link) {
  const std::string check = "others on the line";
  if (link.events.empty()) return Good(check, "nothing unusual");
  return Doubtful(check, fmt::format("{}", fmt::join(link.events, "; ")),
                  "one companion, one set of ids, one source of landing targets");
}

std::vector<Finding> CheckLink(const LinkObservations& link, const DoctorUse& use) {
  std::vector<Finding> findings = {CheckLine(link)};
  if (!link.isrequested || !link.open_error.empty()) return findings;
  findings.push_back(CheckSigning(link));
  findings.push_back(CheckHeartbeat(link));
  if (!link.is_heard) return findings;
  findings.push_back(CheckVersion(link));
  findings.push_back(CheckVehicle(link));
  findings.push_back(CheckAttitudes(link, use));
  findings.push_back(CheckPositions(link, use));
  findings.push_back(CheckEstimate(link, use));
  if (use.pad_position) findings.push_back(CheckOrigin(link, use));
  findings.push_back(CheckAutopilotClock(link));
  findings.push_back(CheckRoundTrip(link, use));
  findings.push_back(CheckLinkEvents(link));
  return findings;
}

}  // namespace kestrel
