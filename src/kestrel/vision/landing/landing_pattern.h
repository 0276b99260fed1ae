// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/core/base/limits.h"
#include "kestrel/vision/target/target_print.h"
#include "kestrel/vision/target/target_shape.h"

namespace kestrel {

// Dimensions of the landing pattern, in metres: a black ring and, inside of it, a black X of two
// arms at right angles, on a white board. The defaults are the MBZIRC 2017 board.
//
// Frame P: origin where the arms meet, x along one arm, z up out of the printed face.
struct LandingPattern {
  static constexpr int kArms = 4;  // half arms of the X, from the centre to an end

  double outer_diameter_m = 1.0;
  double ring_width_m = 0.1;
  double arm_width_m = 0.1;
  double arm_half_length_m = 0.38;
  double board_size_m = 1.5;

  double outer_radius_m() const { return 0.5 * outer_diameter_m; }
  double inner_radius_m() const { return outer_radius_m() - ring_width_m; }

  static void Visit(auto& self, auto&& visit) {
    visit("outer_diameter_m", self.outer_diameter_m, Metres{}, "outer diameter of the black ring");
    visit("ring_width_m", self.ring_width_m, Metres{}, "width of the black ring");
    visit("arm_width_m", self.arm_width_m, Metres{}, "width of an arm of the cross");
    visit("arm_half_length_m", self.arm_half_length_m, Metres{},
          "length from the centre to the end of an arm; at least the inner radius where the arm "
          "touches the ring");
    visit("board_size_m", self.board_size_m, Metres{}, "side of the white board");
  }
  // Returns every violation in words; empty when the dimensions are consistent.
  std::vector<std::string> Validate() const;
};

// Returns the pattern with all dimensions multiplied by 'factor'.
LandingPattern Scaled(const LandingPattern& pattern, double factor);

// Returns the pattern as a pad: the edges of ring and cross.
TargetShape ShapeOf(const LandingPattern& pattern);

// Returns the print, whose arms point to the corners of the board.
TargetPrint PrintOf(const LandingPattern& pattern);

}  // namespace kestrel
