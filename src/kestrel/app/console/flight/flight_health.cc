// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/flight/flight_health.h"

#include <algorithm>
#include <sys/resource.h>
#include <thread>

#include <fmt/format.h>

namespace kestrel {
namespace {

constexpr Duration kInterval = std::chrono::seconds(1);

// Processor time of the whole program, s.
double CpuTime_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// A check that has had no time to be made.
ConsoleCheck NotYet(const char* name) { return {name, "not checked", "not checked yet"}; }

ConsoleCheck CameraCheck(const FlightReport& now, const FlightReport& last, double interval_s) {
  if (now.capture.captured == 0 && now.trouble.empty()) return NotYet("camera");
  const auto frames = static_cast<double>(now.capture.captured - last.capture.captured);
  const bool is_missing = now.capture.missed > last.capture.missed;
  const bool is_repeating = now.repeated_frames > last.repeated_frames;
  ConsoleCheck check{"camera", is_missing || is_repeating ? "doubtful" : "good",
                     fmt::format("{:.1f} frames/s, {} missed, {} repeated", frames / interval_s,
                                 now.capture.missed, now.repeated_frames)};
  if (frames == 0) check.verdict = "wrong";
  if (!now.trouble.empty()) check.measured = now.trouble;
  return check;
}

ConsoleCheck VisionCheck(const FlightReport& now, const FlightReport& last) {
  const bool is_late = now.events.dropped_frames > last.events.dropped_frames;
  const bool is_unposed = now.events.unposed_frames > last.events.unposed_frames;
  return {"vision", is_late || is_unposed ? "doubtful" : "good",
          fmt::format("{} frames, {} dropped for want of time, {} without a pose in time",
                      now.events.frames, now.events.dropped_frames, now.events.unposed_frames)};
}

ConsoleCheck LinkCheck(const AutopilotState& autopilot, double rate_hz, bool is_damaged) {
  if (!autopilot.is_here) {
    const bool was_here = !autopilot.mode.empty();
    if (was_here) return {"autopilot", "wrong", "no heartbeat"};
    if (autopilot.waits.empty()) return NotYet("autopilot");
    return {"autopilot", "wrong", autopilot.waits};
  }
  if (rate_hz == 0) return {"autopilot", "wrong", "no packets"};
  return {"autopilot", is_damaged ? "doubtful" : "good",
          fmt::format("{:.0f} packets/s, {} damaged, {} not sent", rate_hz,
                      autopilot.link.bad_checksums, autopilot.link.unsent)};
}

ConsoleCheck ProcessorCheck(double cpu_s, double interval_s) {
  constexpr double kNearlyAll = 0.9;
  const auto processors = std::max(1U, std::thread::hardware_concurrency());
  const double load = cpu_s / interval_s;
  return {"processor", load < kNearlyAll * processors ? "good" : "doubtful",
          fmt::format("{:.0f} % of one, there are {}", 100 * load, processors)};
}

ConsoleCheck RecorderCheck(const RecorderCounters& now,
                           const std::optional<RecorderCounters>& last) {
  const bool is_dropping = last && now.dropped > last->dropped;
  return {"recording", is_dropping ? "doubtful" : "good",
          fmt::format("{} images, {:.0f} MB, {} dropped", now.images,
                      static_cast<double>(now.bytes) / 1e6, now.dropped)};
}

ConsoleCheck BatteryFact(const AutopilotState& autopilot) {
  constexpr double kLow = 0.25;
  constexpr double kEmpty = 0.1;
  ConsoleCheck fact{"battery", "good", ""};
  if (autopilot.battery_v) fact.measured = fmt::format("{:.1f} V", *autopilot.battery_v);
  if (!autopilot.battery_remaining) return fact;
  const double remaining = *autopilot.battery_remaining;
  fact.measured += fmt::format("{}{:.0f} %", autopilot.battery_v ? ", " : "", 100 * remaining);
  if (remaining < kLow) fact.verdict = remaining < kEmpty ? "wrong" : "doubtful";
  return fact;
}

ConsoleCheck GnssFact(const AutopilotState& autopilot) {
  constexpr int kFlat = 2;
  constexpr int kWithHeight = 3;
  const int fix = *autopilot.gnss_fix;
  ConsoleCheck fact{"GPS", "good",
                    fix < kFlat         ? "no fix"
                    : fix < kWithHeight ? "no height"
                                        : "fix"};
  if (fix < kWithHeight) fact.verdict = fix < kFlat ? "wrong" : "doubtful";
  if (autopilot.satellites) fact.measured += fmt::format(", {} satellites", *autopilot.satellites);
  return fact;
}

}  // namespace

std::optional<ConsoleVehicle> VehicleOf(const FlightReport& report) {
  if (!report.autopilot) return std::nullopt;
  const AutopilotState& autopilot = *report.autopilot;
  ConsoleVehicle vehicle;
  vehicle.facts = {{"mode", autopilot.is_here ? "good" : "wrong",
                    autopilot.is_here ? autopilot.mode : "no heartbeat"},
                   {"motors", "good", autopilot.is_armed ? "armed" : "disarmed"}};
  if (autopilot.battery_v || autopilot.battery_remaining) {
    vehicle.facts.push_back(BatteryFact(autopilot));
  }
  if (autopilot.gnss_fix) vehicle.facts.push_back(GnssFact(autopilot));
  if (autopilot.has_good_position) {
    const bool is_good = *autopilot.has_good_position;
    vehicle.facts.push_back(
        {"position", is_good ? "good" : "wrong", is_good ? "trusted" : "not trusted"});
  }
  if (const auto& limits = autopilot.limits) {
    vehicle.limits = {{"lean", limits->lean_share},
                      {"speed", limits->speed_share},
                      {"climb", limits->climb_share}};
    vehicle.cannot_follow = limits->cannot_follow;
  }
  return vehicle;
}

void SourceWatch::Look(Time captured, bool has_pose) {
  frame_ = captured;
  if (has_pose) pose_ = captured;
}

// Others may send over the link of an autopilot that is dead.
ConsoleSources SourceWatch::Update(const FlightReport& report, Time now) {
  ConsoleSources sources{now, {}};
  const auto add = [&](ValueSource source, const std::optional<Time>& newest) {
    sources.ages.push_back({source, newest ? std::optional(now - *newest) : std::nullopt});
  };
  add(ValueSource::kFrames, frame_);
  if (report.autopilot) {
    const std::uint64_t received = report.autopilot->link.received;
    if (report.autopilot->is_here && received != received_) autopilot_ = now;
    received_ = received;
    add(ValueSource::kAutopilot, autopilot_);
  }
  if (report.autopilot || pose_) add(ValueSource::kPose, pose_);
  return sources;
}

std::optional<ConsoleHealth> FlightHealth::Update(const FlightReport& report, Time now) {
  if (checked_ && now - *checked_ < kInterval) return std::nullopt;
  std::optional<ConsoleHealth> health;
  if (checked_) health = Compare(report, ToSeconds(now - *checked_));
  checked_ = now;
  last_ = report;
  last_cpu_s_ = CpuTime_s();
  return health;
}

ConsoleHealth FlightHealth::Compare(const FlightReport& report, double interval_s) {
  ConsoleHealth health;
  health.checks = {CameraCheck(report, last_, interval_s), VisionCheck(report, last_)};
  if (report.autopilot && last_.autopilot) {
    const ConnectionCounters& link = report.autopilot->link;
    const ConnectionCounters& last = last_.autopilot->link;
    link_rate_hz_ = static_cast<double>(link.received - last.received) / interval_s;
    const bool is_damaged = link.bad_checksums > last.bad_checksums || link.unsent > last.unsent;
    health.checks.push_back(LinkCheck(*report.autopilot, *link_rate_hz_, is_damaged));
  }
  health.checks.push_back(ProcessorCheck(CpuTime_s() - last_cpu_s_, interval_s));
  if (report.recorder) health.checks.push_back(RecorderCheck(*report.recorder, last_.recorder));
  return health;
}

ViewStatus FlightStatus(const FlightReport& report, const ViewStatus& vision) {
  ViewStatus status = vision;
  status.is_recording = report.recorder.has_value();
  if (report.end) {
    status = {.state = "flight over", .reason = InWords(*report.end), .is_over = true};
    status.replay = report.recording;
  } else if (!report.trouble.empty()) {
    status.state = "blind";
    status.reason = report.trouble;
  } else if (report.autopilot && report.autopilot->target == TargetPhase::kContact) {
    status.state = "on the pattern";
    status.reason = "";
  } else if (report.autopilot && !report.autopilot->is_here) {
    const std::string& waits = report.autopilot->waits;
    status.reason = waits.empty() ? "no heartbeat of the autopilot" : waits;
  } else if (report.autopilot &&
             report.autopilot->guidance.value_or(GuidancePhase::kIdle) != GuidancePhase::kIdle) {
    status.state = fmt::format("{}, {}", ToString(*report.autopilot->guidance), vision.state);
  } else if (report.autopilot && report.autopilot->is_landing) {
    status.state = fmt::format("landing, {}", vision.state);
  }
  return status;
}

}  // namespace kestrel
