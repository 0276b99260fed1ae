// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/vision/target/target_print.h"
#include "kestrel/vision/target/target_shape.h"

namespace kestrel {

// Dimensions of a helipad, in metres: an H of two legs and a bar, within a circle or a square. The
// proportions of the H are those of ICAO Annex 14, volume II, 5.2.2: 3 m high, 1.8 m wide, strokes
// of 0.4 m.
//
// Frame P: origin in the middle of the bar, y along the legs, z up out of the printed face.
struct Helipad {
  double height_m = 1;           // length of the legs
  double width_m = 0.6;          // from outside to outside of the legs
  double stroke_m = 0.4 / 3;     // width of legs and bar
  std::string frame = "circle";  // circle, square or none
  double frame_size_m = 1.5;     // outer diameter, or outer side
  double frame_width_m = 0.1;    // width of its line
  double board_size_m = 1.7;     // side of the square board
  bool white = true;             // white on a black board, otherwise black on white

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("height_m", self.height_m, "m", "length of the H's legs");
    visitor("width_m", self.width_m, "m", "width of the H, from outside to outside of its legs");
    visitor("stroke_m", self.stroke_m, "m", "width of the H's legs and of its bar");
    visitor("frame", self.frame, "", "line around the H: circle, square or none");
    visitor("frame_size_m", self.frame_size_m, "m", "outer diameter of the circle, or outer side");
    visitor("frame_width_m", self.frame_width_m, "m", "width of the frame's line");
    visitor("board_size_m", self.board_size_m, "m", "side of the board");
    visitor("white", self.white, "", "white on a black board; otherwise black on a white one");
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
