// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/vision/tags/tag_board.h"

namespace kestrel {

enum class LensBoardKind { kChessboard, kCharuco, kAprilGrid };

// A board that other tools calibrate cameras by.
struct LensBoard {
  LensBoardKind kind = LensBoardKind::kChessboard;
  // Number of corners where four squares meet (chessboard), of squares (ChArUco), of tags
  // (AprilGrid).
  int columns = 9;
  int rows = 6;
  double side_m = 0.025;            // side of a square; of an AprilGrid's tag
  double marker_m = 0;              // side of a ChArUco board's markers
  double gap = 0;                   // between an AprilGrid's tags, in sides of a tag
  std::string family = "tag36h11";  // family of the tags or markers
  // The upper left square of a ChArUco board is white: boards of OpenCV before 4.6 with an even
  // number of rows.
  bool begins_white = false;

  // Returns the tags on the board; none of a chessboard. Its frame: x to the right, y up, z out of
  // the print, the origin in the middle.
  TagBoard Tags() const;
  // Returns the corners where squares meet; none of an AprilGrid. The same frame, row by row from
  // the upper left, m.
  std::vector<Eigen::Vector2d> Corners() const;
  // Width and height of what is printed, m.
  Eigen::Vector2d Size() const;
};

// Parses "chessboard:9x6:0.025" (inner corners, square in m), "charuco:7x5:0.04:0.03" (squares,
// square and marker in m; ":DICT_5X5_100" or ":aruco_5x5_100" at the end: another dictionary than
// aruco_4x4_50) and "aprilgrid:6x6:0.088:0.3" (tags, tag in m, gap over tag). Throws InputError
// with what was expected.
LensBoard ParseLensBoard(const std::string& text);

}  // namespace kestrel
