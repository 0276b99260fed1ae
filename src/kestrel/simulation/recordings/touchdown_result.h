// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/flight/guidance/landing_guidance.h"

namespace kestrel {

enum class TouchdownOutcome {
  kLanded,
  kTooFast,      // came down on the board, but too fast
  kBesideBoard,  // came down beside the board
  kTimeUp,       // still in the air after the last image
};
const char* ToString(TouchdownOutcome outcome);  // "landed", "too fast", ...

// Positions when an image was taken (for plots).
struct TouchdownMoment {
  Time time;
  GuidancePhase phase = GuidancePhase::kIdle;
  Eigen::Vector3d feet_in_world{0, 0, 0};          // true
  Eigen::Vector3d pattern_in_world{0, 0, 0};       // true
  std::optional<Eigen::Vector3d> target_in_world;  // by the track
};

// The outcome of a flight.
struct TouchdownResult {
  TouchdownOutcome outcome = TouchdownOutcome::kTimeUp;
  double time_s = 0;                   // from the start to the end
  std::optional<double> first_seen_s;  // time of the first image that showed it
  double distance_m = 0;  // distance from the feet's middle to the pattern's, on the board
  double slip_mps = 0;    // horizontal speed relative to the board
  double sink_mps = 0;    // vertical speed relative to the board
  // Angle of the nose, rad, counter-clockwise from above, off the heading that was wanted over
  // the pad; nothing: any heading would do.
  std::optional<double> heading_error;
  double wind_mps = 0;  // mean over the flight
  int go_arounds = 0;
  int frames = 0;
  std::vector<TouchdownMoment> path;  // one for each image
};

// Returns the flight in words, a few lines.
std::string InWords(const TouchdownResult& result);

// touchdown.csv: one row per flight. touchdown_path.csv: one row per image.
std::string TouchdownCsvHeader();
std::string TouchdownCsvRow(std::uint64_t seed, const TouchdownResult& result);
std::string TouchdownPathCsv(const TouchdownResult& result);

}  // namespace kestrel
