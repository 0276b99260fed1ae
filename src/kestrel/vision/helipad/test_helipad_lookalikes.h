// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/target/target_print.h"

namespace kestrel {

// A straight stroke of a figure, in half heights of the figure.
struct LookalikeStroke {
  Eigen::Vector2d from, to;
};

struct LookalikeFigure {
  std::string name;
  std::vector<LookalikeStroke> strokes;
};

// Letters, digits, arrows, crosses, road markings, windows, and what an H is not quite.
inline const std::vector<LookalikeFigure>& LookalikeFigures() {
  static const std::vector<LookalikeFigure> figures = {
      {"N", {{{-.5, -1}, {-.5, 1}}, {{-.5, 1}, {.5, -1}}, {{.5, -1}, {.5, 1}}}},
      {"M", {{{-.6, -1}, {-.6, 1}}, {{-.6, 1}, {0, 0}}, {{0, 0}, {.6, 1}}, {{.6, 1}, {.6, -1}}}},
      {"W",
       {{{-.6, 1}, {-.3, -1}}, {{-.3, -1}, {0, .4}}, {{0, .4}, {.3, -1}}, {{.3, -1}, {.6, 1}}}},
      {"A", {{{-.5, -1}, {0, 1}}, {{0, 1}, {.5, -1}}, {{-.3, -.2}, {.3, -.2}}}},
      {"E",
       {{{-.5, -1}, {-.5, 1}}, {{-.5, 1}, {.5, 1}}, {{-.5, 0}, {.4, 0}}, {{-.5, -1}, {.5, -1}}}},
      {"F", {{{-.5, -1}, {-.5, 1}}, {{-.5, 1}, {.5, 1}}, {{-.5, 0}, {.4, 0}}}},
      {"K", {{{-.5, -1}, {-.5, 1}}, {{-.5, 0}, {.5, 1}}, {{-.5, 0}, {.5, -1}}}},
      {"L", {{{-.5, 1}, {-.5, -1}}, {{-.5, -1}, {.5, -1}}}},
      {"T", {{{0, -1}, {0, 1}}, {{-.6, 1}, {.6, 1}}}},
      {"X", {{{-.5, -1}, {.5, 1}}, {{-.5, 1}, {.5, -1}}}},
      {"Y", {{{0, -1}, {0, 0}}, {{0, 0}, {.5, 1}}, {{0, 0}, {-.5, 1}}}},
      {"Z", {{{-.5, 1}, {.5, 1}}, {{.5, 1}, {-.5, -1}}, {{-.5, -1}, {.5, -1}}}},
      {"U", {{{-.5, 1}, {-.5, -1}}, {{-.5, -1}, {.5, -1}}, {{.5, -1}, {.5, 1}}}},
      {"I", {{{0, -1}, {0, 1}}, {{-.5, 1}, {.5, 1}}, {{-.5, -1}, {.5, -1}}}},
      {"1", {{{0, -1}, {0, 1}}}},
      {"4", {{{-.5, 1}, {-.5, 0}}, {{-.5, 0}, {.5, 0}}, {{.5, 1}, {.5, -1}}}},
      {"5",
       {{{.5, 1}, {-.5, 1}},
        {{-.5, 1}, {-.5, 0}},
        {{-.5, 0}, {.5, 0}},
        {{.5, 0}, {.5, -1}},
        {{.5, -1}, {-.5, -1}}}},
      {"8",
       {{{-.5, -1}, {-.5, 1}},
        {{.5, -1}, {.5, 1}},
        {{-.5, 1}, {.5, 1}},
        {{-.5, -1}, {.5, -1}},
        {{-.5, 0}, {.5, 0}}}},
      {"upper half of 8",
       {{{-.5, -1}, {-.5, 1}}, {{.5, -1}, {.5, 1}}, {{-.5, 1}, {.5, 1}}, {{-.5, 0}, {.5, 0}}}},
      {"arrow", {{{0, -1}, {0, 1}}, {{-.5, .5}, {0, 1}}, {{0, 1}, {.5, .5}}}},
      {"two-headed arrow",
       {{{0, -1}, {0, 1}},
        {{-.5, .5}, {0, 1}},
        {{0, 1}, {.5, .5}},
        {{-.5, -.5}, {0, -1}},
        {{0, -1}, {.5, -.5}}}},
      {"cross", {{{0, -1}, {0, 1}}, {{-1, 0}, {1, 0}}}},
      {"two lines", {{{-.5, -1}, {-.5, 1}}, {{.5, -1}, {.5, 1}}}},
      {"zebra", {{{-.6, -1}, {-.6, 1}}, {{0, -1}, {0, 1}}, {{.6, -1}, {.6, 1}}}},
      {"ladder",
       {{{-.5, -1}, {-.5, 1}},
        {{.5, -1}, {.5, 1}},
        {{-.5, .6}, {.5, .6}},
        {{-.5, -.6}, {.5, -.6}}}},
      {"ladder of three rungs",
       {{{-.5, -1}, {-.5, 1}},
        {{.5, -1}, {.5, 1}},
        {{-.5, .6}, {.5, .6}},
        {{-.5, 0}, {.5, 0}},
        {{-.5, -.6}, {.5, -.6}}}},
      {"parking lots",
       {{{-1, 0}, {1, 0}}, {{-1, -1}, {-1, 1}}, {{0, -1}, {0, 1}}, {{1, -1}, {1, 1}}}},
      {"row of parking lots",
       {{{-1, -1}, {1, -1}}, {{-1, -1}, {-1, 1}}, {{0, -1}, {0, 1}}, {{1, -1}, {1, 1}}}},
      {"window of four panes",
       {{{-.5, -1}, {-.5, 1}},
        {{.5, -1}, {.5, 1}},
        {{-.5, 1}, {.5, 1}},
        {{-.5, -1}, {.5, -1}},
        {{-.5, 0}, {.5, 0}},
        {{0, -1}, {0, 1}}}},
      {"H with its bar high", {{{-.5, -1}, {-.5, 1}}, {{.5, -1}, {.5, 1}}, {{-.5, .5}, {.5, .5}}}},
      {"h", {{{-.5, -1}, {-.5, 1}}, {{-.5, 0}, {.5, 0}}, {{.5, 0}, {.5, -1}}}},
      {"H with a leg of half its length",
       {{{-.5, -1}, {-.5, 1}}, {{.5, -.5}, {.5, .5}}, {{-.5, 0}, {.5, 0}}}},
      {"H as wide as high", {{{-1, -1}, {-1, 1}}, {{1, -1}, {1, 1}}, {{-1, 0}, {1, 0}}}},
      {"H with half of its bar",
       {{{-.5, -1}, {-.5, 1}}, {{.5, -1}, {.5, 1}}, {{-.5, 0}, {-.1, 0}}}},
      {"half an H", {{{-.5, -1}, {-.5, 1}}, {{-.5, 0}, {.5, 0}}}},
      {"slanted H", {{{-.8, -1}, {-.2, 1}}, {{.2, -1}, {.8, 1}}, {{-.5, 0}, {.5, 0}}}},
  };
  return figures;
}

inline PrintPolygon StrokeArea(const LookalikeStroke& stroke, double width) {
  const Eigen::Vector2d along = (stroke.to - stroke.from).normalized();
  const Eigen::Vector2d side = 0.5 * width * Eigen::Vector2d(-along.y(), along.x());
  const Eigen::Vector2d end = 0.5 * width * along;
  return {{{stroke.from - end + side, stroke.to + end + side, stroke.to + end - side,
            stroke.from - end - side}}};
}

// A figure on a board.
struct Lookalike {
  std::string name;
  Eigen::Vector2d place;
  double turn;  // rad
};

inline constexpr int kLookalikesPerBoard = 9;
inline constexpr double kLookalikeCell = 1.7;  // m

struct LookalikeBoard {
  TargetPrint print;
  std::vector<Lookalike> figures;

  // Returns the name of the figure that is nearest.
  std::string NameAt(const Eigen::Vector2d& place) const {
    const auto away = [&](const Lookalike& figure) { return (figure.place - place).norm(); };
    return std::min_element(
               figures.begin(), figures.end(),
               [&](const Lookalike& a, const Lookalike& b) { return away(a) < away(b); })
        ->name;
  }
};

// Returns nine figures of random sizes, widths, slants and turns on one board, some within a
// circle.
inline LookalikeBoard RandomLookalikeBoard(bool white, Random* random) {
  LookalikeBoard board;
  board.print.board_size_m = 3 * kLookalikeCell;
  board.print.board_gray = white ? 0 : 1;
  const double ink = white ? 1 : 0;
  for (int cell = 0; cell < kLookalikesPerBoard; ++cell) {
    const int row = cell / 3;
    const Eigen::Vector2d place(kLookalikeCell * (cell % 3 - 1), kLookalikeCell * (row - 1));
    const int last = static_cast<int>(LookalikeFigures().size()) - 1;
    const LookalikeFigure& figure = LookalikeFigures()[random->Integer(0, last)];
    const double half = random->Uniform(0.25, 0.5);
    const double width = random->Uniform(0.18, 0.34);
    const double wide = random->Uniform(0.8, 1.2);
    const double turn = random->Uniform(0, 2 * kPi);
    for (const LookalikeStroke& stroke : figure.strokes) {
      const Eigen::Vector2d scale(half * wide, half);
      const LookalikeStroke sized{scale.cwiseProduct(stroke.from), scale.cwiseProduct(stroke.to)};
      board.print.shapes.push_back(Moved({StrokeArea(sized, width * half), ink}, turn, place));
    }
    if (random->Chance(0.3)) board.print.shapes.push_back({PrintRing{place, 0.8, 0.72}, ink});
    board.figures.push_back({figure.name, place, turn});
  }
  return board;
}

}  // namespace kestrel
