// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/touchdown_result.h"

#include <fmt/format.h>

#include "kestrel/core/base/fixed.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

std::string Cells(const Eigen::Vector3d& point) {
  return fmt::format("{:.4f},{:.4f},{:.4f}", point.x(), point.y(), point.z());
}

std::string EndInWords(const TouchdownResult& result) {
  if (result.outcome == TouchdownOutcome::kTimeUp) {
    return fmt::format("still in the air after {:.1f} s", result.time_s);
  }
  const std::string heading =
      result.heading_error
          ? fmt::format(", heading off by {} degrees", Fixed(Degrees(*result.heading_error), 1))
          : "";
  return fmt::format(
      "{} {:.1f} s after the start, {:.2f} m from the centre (true), at {:.2f} m/s against the "
      "board "
      "({:.2f} m/s down){}",
      ToString(result.outcome), result.time_s, result.distance_m, result.slip_mps, result.sink_mps,
      heading);
}

}  // namespace

const char* ToString(TouchdownOutcome outcome) {
  switch (outcome) {
    case TouchdownOutcome::kLanded:
      return "landed";
    case TouchdownOutcome::kTooFast:
      return "too fast";
    case TouchdownOutcome::kBesideBoard:
      return "beside the board";
    case TouchdownOutcome::kTimeUp:
      return "time up";
  }
  return "";
}

std::string InWords(const TouchdownResult& result) {
  const std::string seen =
      result.first_seen_s ? fmt::format("pattern first seen after {:.1f} s", *result.first_seen_s)
                          : "pattern never seen";
  return fmt::format("{}; {}, went up again {} times, wind {:.1f} m/s\n", EndInWords(result), seen,
                     result.go_arounds, result.wind_mps);
}

std::string TouchdownCsvHeader() {
  return "seed,outcome,time_s,first_seen_s,distance_m,slip_mps,sink_mps,go_arounds,wind_mps,"
         "frames,heading_error_deg\n";
}

std::string TouchdownCsvRow(std::uint64_t seed, const TouchdownResult& result) {
  const bool is_down = result.outcome != TouchdownOutcome::kTimeUp;
  return fmt::format(
      "{},{},{:.3f},{},{},{},{},{:.2f},{},{}\n", seed, ToString(result.outcome), result.time_s,
      result.first_seen_s ? fmt::format("{:.3f}", *result.first_seen_s) : "",
      is_down ? fmt::format("{:.4f}", result.distance_m) : "",
      is_down ? fmt::format("{:.3f},{:.3f}", result.slip_mps, result.sink_mps) : ",",
      result.go_arounds, result.wind_mps, result.frames,
      result.heading_error ? fmt::format("{:.2f}", Degrees(*result.heading_error)) : "");
}

std::string TouchdownPathCsv(const TouchdownResult& result) {
  std::string text =
      "timestamp_ns,phase,feet_x_m,feet_y_m,feet_z_m,pattern_x_m,pattern_y_m,pattern_z_m,"
      "track_x_m,track_y_m,track_z_m\n";
  for (const TouchdownMoment& moment : result.path) {
    text += fmt::format("{},{},{},{},{}\n", ToNanoseconds(moment.time), ToString(moment.phase),
                        Cells(moment.feet_in_world), Cells(moment.pattern_in_world),
                        moment.target_in_world ? Cells(*moment.target_in_world) : ",,");
  }
  return text;
}

}  // namespace kestrel
