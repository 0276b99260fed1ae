// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/landing/pattern_locator.h"
#include "kestrel/vision/landing/print_doubts.h"
#include "kestrel/vision/landing/seen_print.h"

namespace kestrel {

// A print that was located, whether it is the pattern or not.
struct PrintFinding {
  PrintKind kind;
  CrossMethod method;
  PatternLocation location;
  std::optional<SeenPrint> seen;  // by its edges
  double seen_rms_px = 0;         // root mean square of how far these are from there
  Eigen::Vector2d center_px;      // where the image has the middle of the print
  Eigen::Vector2d diameters_px;   // of the ring, the longer one first
  PrintDoubts doubts;
  double log_odds = 0;  // that it is the pattern, by the doubts
  double told = 0;      // what the hint adds to that; 0 at most

  bool is_part() const { return method == CrossMethod::kPartial; }
  // Standard deviation of the position, share of the distance.
  double relative_sigma() const;
};

}  // namespace kestrel
