// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/limits.h"
#include "kestrel/vision/target/target_print.h"
#include "kestrel/vision/target/target_shape.h"

namespace kestrel {

// Dimensions of a helipad, in metres: an H of two legs and a bar, within a circle or a square. The
// proportions of the H are those of ICAO Annex 14, volume II, 5.2.2: 3 m high, 1.8 m wide, strokes
// of 0.4 m.
//
// Frame P: origin in the middle of the bar, y along the legs, z up out of the printed face.
struct Helipad {
  double height_m = 1;
  double width_m = 0.6;
  double stroke_m = 0.4 / 3;
  std::string frame = "circle";
  double frame_size_m = 1.5;
  double frame_width_m = 0.1;
  double board_size_m = 1.7;
  bool white = true;

  static void Visit(auto& self, auto&& visit) {
    visit("height_m", self.height_m, Metres{}, "length of the H's legs");
    visit("width_m", self.width_m, Metres{}, "width of the H, from outside to outside of its legs");
    visit("stroke_m", self.stroke_m, Metres{}, "width of the H's legs and of its bar");
    visit("frame", self.frame, OneOf{{"circle", "square", "none"}}, "line around the H");
    visit("frame_size_m", self.frame_size_m, "outer diameter of the circle, or outer side");
    visit("frame_width_m", self.frame_width_m, "width of the frame's line");
    visit("board_size_m", self.board_size_m, Metres{100}, "side of the board");
    visit("white", self.white, "white on a black board; otherwise black on a white one");
  }
  // Returns every violation in words; empty when the dimensions are consistent.
  std::vector<std::string> Validate() const;
};

// Returns the twelve corners of the H, clockwise from the upper left.
std::vector<Eigen::Vector2d> CornersOf(const Helipad& helipad);

// Returns the helipad with all lengths multiplied by 'factor'.
Helipad Scaled(const Helipad& helipad, double factor);

TargetPrint PrintOf(const Helipad& helipad);

// Returns the edges: the frame's outer one, where there is a frame, and that of the H.
TargetShape ShapeOf(const Helipad& helipad);

}  // namespace kestrel
