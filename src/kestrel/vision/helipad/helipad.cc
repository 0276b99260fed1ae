// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/helipad/helipad.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "kestrel/core/base/limits.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Polyline = std::vector<Eigen::Vector3d>;

// A lens bends lines; therefore an edge has this number of pieces.
constexpr int kPiecesPerSide = 12;
constexpr int kPiecesAround = 96;

Polyline ClosedLine(const std::vector<Vector2d>& corners) {
  Polyline line;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d& from = corners[i];
    const Vector2d side = corners[(i + 1) % corners.size()] - from;
    for (int k = 0; k <= kPiecesPerSide; ++k) {
      const Vector2d point = from + side * k / kPiecesPerSide;
      line.emplace_back(point.x(), point.y(), 0);
    }
  }
  return line;
}

Polyline CircleLine(double radius) {
  Polyline line;
  for (int i = 0; i <= kPiecesAround; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPiecesAround;
    line.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  return line;
}

PrintShape FrameOf(const Helipad& helipad, double gray) {
  const double outer = helipad.frame_size_m;
  const double inner = outer - 2 * helipad.frame_width_m;
  if (helipad.frame == "circle") return {PrintRing{{0, 0}, 0.5 * outer, 0.5 * inner}, gray};
  PrintPolygon square = Rectangle({0, 0}, {outer, outer});
  std::vector<Vector2d> hole = Rectangle({0, 0}, {inner, inner}).loops[0];
  std::reverse(hole.begin(), hole.end());
  square.loops.push_back(std::move(hole));
  return {square, gray};
}

}  // namespace

std::vector<std::string> Helipad::Validate() const {
  std::vector<std::string> violations;
  constexpr double kLargestFrame = 100;  // m: real helipads have large circles around an H
  if (frame == "circle" || frame == "square") {
    Require(frame_size_m, Metres{kLargestFrame}, "frame_size_m", &violations);
    Require(frame_width_m, Metres(), "frame_width_m", &violations);
  }
  if (!violations.empty()) return violations;
  // The detector needs a gap on all sides of the bar that is not much thinner than a stroke.
  Require(stroke_m, Range{0.05 * height_m, height_m / 4}, "stroke_m", &violations);
  Require(width_m, Range{2.5 * stroke_m, 2 * height_m}, "width_m", &violations);
  const double diagonal = std::hypot(height_m, width_m);
  if (frame == "none") {
    if (std::max(height_m, width_m) > board_size_m) {
      violations.push_back(
          fmt::format("board_size_m is {:.7g}, expected room for the H", board_size_m));
    }
    return violations;
  }
  const double least =
      (frame == "circle" ? diagonal : std::max(height_m, width_m)) + 2 * frame_width_m;
  if (!(frame_size_m > least)) {
    violations.push_back(
        fmt::format("frame_size_m is {:.7g}, expected more than {:.3g} for the H within it",
                    frame_size_m, least));
  }
  if (!(board_size_m >= frame_size_m)) {
    violations.push_back(
        fmt::format("board_size_m is {:.7g}, expected at least frame_size_m, {:.7g}", board_size_m,
                    frame_size_m));
  }
  return violations;
}

std::vector<Vector2d> CornersOf(const Helipad& helipad) {
  const double right = 0.5 * helipad.width_m;
  const double inside = right - helipad.stroke_m;
  const double top = 0.5 * helipad.height_m;
  const double bar = 0.5 * helipad.stroke_m;
  return {{-right, top},  {-inside, top},  {-inside, bar},  {inside, bar},
          {inside, top},  {right, top},    {right, -top},   {inside, -top},
          {inside, -bar}, {-inside, -bar}, {-inside, -top}, {-right, -top}};
}

Helipad Scaled(const Helipad& helipad, double factor) {
  Helipad scaled = helipad;
  for (double Helipad::*const length :
       {&Helipad::height_m, &Helipad::width_m, &Helipad::stroke_m, &Helipad::frame_size_m,
        &Helipad::frame_width_m, &Helipad::board_size_m}) {
    scaled.*length *= factor;
  }
  return scaled;
}

TargetPrint PrintOf(const Helipad& helipad) {
  const double ink = helipad.white ? 1 : 0;
  TargetPrint print;
  print.board_size_m = helipad.board_size_m;
  print.board_gray = 1 - ink;
  if (helipad.frame != "none") print.shapes.push_back(FrameOf(helipad, ink));
  print.shapes.push_back({PrintPolygon{{CornersOf(helipad)}}, ink});
  print.dimensions = {fmt::format("H: {:g} mm high, {:g} mm wide, strokes of {:.4g} mm",
                                  1000 * helipad.height_m, 1000 * helipad.width_m,
                                  1000 * helipad.stroke_m)};
  if (helipad.frame != "none") {
    print.dimensions.push_back(fmt::format("{}: {:g} mm outside, {:g} mm wide", helipad.frame,
                                           1000 * helipad.frame_size_m,
                                           1000 * helipad.frame_width_m));
  }
  print.dimensions.push_back(fmt::format("board: {0:g} x {0:g} mm, {1}",
                                         1000 * helipad.board_size_m,
                                         helipad.white ? "black" : "white"));
  return print;
}

TargetShape ShapeOf(const Helipad& helipad) {
  constexpr double kSightPx = 20;  // extent of an H that nearly all images show
  TargetShape shape;
  shape.board_size_m = helipad.board_size_m;
  shape.diameter_m = std::hypot(helipad.height_m, helipad.width_m);
  shape.max_pixel_m = shape.diameter_m / kSightPx;
  if (helipad.frame == "circle") {
    shape.outlines.push_back(CircleLine(0.5 * helipad.frame_size_m));
  } else if (helipad.frame == "square") {
    shape.outlines.push_back(
        ClosedLine(Rectangle({0, 0}, Vector2d::Constant(helipad.frame_size_m)).loops[0]));
  }
  shape.outlines.push_back(ClosedLine(CornersOf(helipad)));
  return shape;
}

}  // namespace kestrel
