// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace kestrel {

// A ring, or a disc where 'inner_radius_m' is 0.
struct PrintRing {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double outer_radius_m = 0;
  double inner_radius_m = 0;
};

// The area within closed lines: outlines clockwise as seen, holes counter-clockwise. The last
// corner of a line is joined to the first.
struct PrintPolygon {
  std::vector<std::vector<Eigen::Vector2d>> loops;
};

struct PrintShape {
  std::variant<PrintRing, PrintPolygon> area;
  double gray = 0;  // 0 black, 1 white
};

// The print on the board of a pad. All that draws pads, on paper or in a simulated world,
// knows a pad by this alone. In metres, in frame P of the pad (TargetShape).
struct TargetPrint {
  double board_size_m = 0;           // side of the square board, centred on the origin of P
  double board_gray = 1;             // 0 black, 1 white
  double board_heading = 0;          // rad, of P's x axis on the board, counter-clockwise as seen
  std::vector<PrintShape> shapes{};  // each is drawn over those before it
  std::vector<std::string> dimensions{};  // in words, a line each
  // True when `kestrel print --check` can measure a photograph of it.
  bool can_be_checked = false;
};

// Returns a rectangle of two sides, 'size', with its corners clockwise from the upper right.
PrintPolygon Rectangle(const Eigen::Vector2d& center, const Eigen::Vector2d& size);

// Returns the shape turned by 'heading' (rad, counter-clockwise) around the origin, then moved.
PrintShape Moved(const PrintShape& shape, double heading, const Eigen::Vector2d& offset);

// Returns the largest coordinate of all that is printed, from the origin: half the side of the
// square, along the axes of P, that holds it.
double HalfExtent(const TargetPrint& print);

// Returns the side of the square, along the board's sides, that holds all that is printed on a
// white board; of another board, its side.
double InkSize(const TargetPrint& print);

// Returns how far a point of P is from the centre, along the board's sides: at most half the side
// of the board where the point is on it.
double ReachOnBoard(const TargetPrint& print, const Eigen::Vector2d& point);

// Adds the shapes of 'other', in the same frame, over those of 'print'. The board grows to hold
// them.
void PrintOver(const TargetPrint& other, TargetPrint* print);

}  // namespace kestrel
