// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/flight_diagnostics.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace kestrel {
namespace {

KeyValueMessage Value(const char* key, std::uint64_t value) { return {key, fmt::to_string(value)}; }

KeyValueMessage Latency(const char* key, const LatencySummary& latency) {
  return {key, fmt::format("median {:.2f} ms, p99 {:.2f}, max {:.2f}", 1e3 * latency.median_s,
                           1e3 * latency.p99_s, 1e3 * latency.max_s)};
}

}  // namespace

double Rate::Next(std::uint64_t count) {
  const Time now = Now();
  const double rate_hz =
      static_cast<double>(count - count_) / std::max(ToSeconds(now - time_), 1e-3);
  time_ = now;
  count_ = count;
  return rate_hz;
}

DiagnosticStatusMessage DiagnosticsOf(const std::string& name, double rate_hz,
                                      const FlightReport& report, const ResultCounts& counts) {
  DiagnosticStatusMessage status;
  status.name = name;
  const bool is_running = report.trouble.empty() && rate_hz > 0;
  status.level = is_running ? DiagnosticStatusMessage::kOk : DiagnosticStatusMessage::kWarn;
  status.message = !report.trouble.empty() ? report.trouble : is_running ? "running" : "no images";
  if (report.end) {
    status.level = ExitStatus(*report.end) == 0 ? DiagnosticStatusMessage::kOk
                                                : DiagnosticStatusMessage::kWarn;
    status.message = InWords(*report.end);
  }
  const CaptureCounters& capture = report.capture;
  status.values = {{"image rate", fmt::format("{:.1f} Hz", rate_hz)},
                   Value("images captured", capture.captured),
                   Value("images missed before", capture.missed - capture.refused),
                   Value("images left out", capture.refused),
                   Value("images processed", report.events.frames),
                   Value("images with a detection", counts.found),
                   Value("images dropped for newer ones", report.events.dropped_frames),
                   Value("images without the pose after them", report.events.unposed_frames),
                   Latency("image to detection", counts.latency),
                   Latency("of that beyond Detect", counts.beyond_detect),
                   Latency("Detect", counts.detect)};
  return status;
}

DiagnosticArrayMessage ArrayOf(DiagnosticStatusMessage status, Time stamp) {
  DiagnosticArrayMessage message;
  message.header.stamp = stamp;
  message.status.push_back(std::move(status));
  return message;
}

}  // namespace kestrel
