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
  kTooFast,      // came down on the board, but faster than it may
  kBesideBoard,  // came down beside the board
  kTimeUp,       // still in the air after the last image
};
const char* ToString(TouchdownOutcome outcome);  // "landed", "too fast", ...

// Where things were when an image was taken (for plots).
struct TouchdownMoment {
  Time time;
  GuidancePhase phase = GuidancePhase::kIdle;
  Eigen::Vector3d feet_in_world{0, 0, 0};          // true
  Eigen::Vector3d pattern_in_world{0, 0, 0};       // true
  std::optional<Eigen::Vector3d> target_in_world;  // by the track
};

// How a flight ended.
struct TouchdownResult {
  TouchdownOutcome outcome = TouchdownOutcome::kTimeUp;
  double time_s = 0;                   // from the start to the end
  std::optional<double> first_seen_s;  // when the first image was taken that showed it
  double distance_m = 0;               // of the feet's middle from the pattern's, on the board
  double slip_mps = 0;                 // speed against the board, horizontal
  double sink_mps = 0;                 // and vertical
  double wind_mps = 0;                 // mean over the flight
  int go_arounds = 0;
  int frames = 0;
  std::vector<TouchdownMoment> path;  // one for every image
};

// The flight in words, a few lines.
std::string InWords(const TouchdownResult& result);

// touchdown.csv: one row for a flight. touchdown_path.csv: one row for every image.
std::string TouchdownCsvHeader();
std::string TouchdownCsvRow(std::uint64_t seed, const TouchdownResult& result);
std::string TouchdownPathCsv(const TouchdownResult& result);

}  // namespace kestrel
