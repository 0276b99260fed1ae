// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/vision/target/target_print.h"
#include "kestrel/vision/target/target_shape.h"

namespace kestrel {

// Dimensions of the landing pattern, in metres: a black ring and, inside of it, a black X of two
// arms at right angles, on a white board. The defaults are the MBZIRC 2017 board.
//
// Frame P: origin where the arms meet, x along one arm, z up out of the printed face.
struct LandingPattern {
  static constexpr int kArms = 4;  // half arms of the X, from the centre to an end

  double outer_diameter_m = 1.0;    // outer diameter of the ring
  double ring_width_m = 0.1;        // outer minus inner radius of the ring
  double arm_width_m = 0.1;         // across the arm
  double arm_half_length_m = 0.38;  // from the centre to the end of an arm; at least the inner
                                    // radius when the arms touch the ring
  double board_size_m = 1.5;        // side of the white square board around the ring

  double outer_radius_m() const { return 0.5 * outer_diameter_m; }
  double inner_radius_m() const { return outer_radius_m() - ring_width_m; }

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("outer_diameter_m", self.outer_diameter_m, "m", "outer diameter of the black ring");
    visitor("ring_width_m", self.ring_width_m, "m", "width of the black ring");
    visitor("arm_width_m", self.arm_width_m, "m", "width of an arm of the cross");
    visitor("arm_half_length_m", self.arm_half_length_m, "m",
            "length from the centre to the end of an arm; at least the inner radius where the arm "
            "touches the ring");
    visitor("board_size_m", self.board_size_m, "m", "side of the white board");
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
