// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/landing/location/pattern_locator.h"
#include "kestrel/vision/landing/score/print_doubts.h"
#include "kestrel/vision/target/seen_print.h"

namespace kestrel {

// A finding: a print that was located, whether it is the pattern or not.
struct PrintFinding {
  PrintKind kind;
  DetectionMethod method;
  PatternLocation location;
  std::optional<SeenPrint> seen;  // location in the image by its edges
  double seen_rms_px = 0;         // root mean square offset of the edges from 'seen'
  Eigen::Vector2d center_px;      // image of the middle of the print
  Eigen::Vector2d diameters_px;   // diameters of the ring, the longer one first
  PrintDoubts doubts;
  double log_odds = 0;  // that it is the pattern, by the doubts alone
  double by_hint = 0;   // log odds that the hint adds to that; at most 0

  bool is_part() const { return method == DetectionMethod::kPartial; }
  // Standard deviation of the position, as a share of the distance.
  double relative_sigma() const;
};

}  // namespace kestrel
