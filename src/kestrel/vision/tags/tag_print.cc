// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/tag_print.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace kestrel {
namespace {

using Point = std::pair<int, int>;  // column and row, corners of cells

bool IsBlack(const TagGrid& grid, int column, int row) {
  const bool inside = column >= 0 && column < grid.width && row >= 0 && row < grid.width;
  return inside && grid.at(column, row) == TagCell::kBlack;
}

// Returns the sides of black cells that white ones adjoin: from each start to its ends, with black
// on the right.
std::multimap<Point, Point> BlackSides(const TagGrid& grid) {
  std::multimap<Point, Point> sides;
  for (int row = 0; row < grid.width; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      if (!IsBlack(grid, column, row)) continue;
      const Point corners[] = {
          {column, row}, {column + 1, row}, {column + 1, row + 1}, {column, row + 1}};
      const Point beyond[] = {
          {column, row - 1}, {column + 1, row}, {column, row + 1}, {column - 1, row}};
      for (int i = 0; i < 4; ++i) {
        if (IsBlack(grid, beyond[i].first, beyond[i].second)) continue;
        sides.emplace(corners[i], corners[(i + 1) % 4]);
      }
    }
  }
  return sides;
}

bool OnOneLine(const Point& a, const Point& b, const Point& c) {
  return (a.first == b.first && b.first == c.first) ||
         (a.second == b.second && b.second == c.second);
}

// Takes one closed line out of the sides: its corners.
std::vector<Point> TakeLoop(std::multimap<Point, Point>* sides) {
  std::vector<Point> loop;
  const Point first = sides->begin()->first;
  Point at = first;
  do {
    const auto side = sides->find(at);
    const Point next = side->second;
    sides->erase(side);
    if (loop.size() >= 2 && OnOneLine(loop[loop.size() - 2], loop.back(), at)) loop.pop_back();
    loop.push_back(at);
    at = next;
  } while (at != first);
  if (OnOneLine(loop[loop.size() - 2], loop.back(), first)) loop.pop_back();
  return loop;
}

PrintPolygon BlackCells(const PrintedTag& tag) {
  PrintPolygon polygon;
  std::multimap<Point, Point> sides = BlackSides(tag.grid);
  while (!sides.empty()) {
    std::vector<Eigen::Vector2d>& loop = polygon.loops.emplace_back();
    for (const Point& corner : TakeLoop(&sides)) {
      loop.push_back(tag.OnBoard(corner.first, corner.second));
    }
  }
  return polygon;
}

// Returns all that belongs to the tag.
PrintPolygon WholeTag(const PrintedTag& tag) {
  const int end = tag.grid.width;
  return {{{tag.OnBoard(0, 0), tag.OnBoard(end, 0), tag.OnBoard(end, end), tag.OnBoard(0, end)}}};
}

std::vector<std::string> DimensionLines(const TagBoard& board) {
  constexpr std::size_t kMost = 4;
  std::vector<std::string> lines;
  if (board.tags.size() > kMost) {
    const auto [least, most] = std::minmax_element(
        board.tags.begin(), board.tags.end(),
        [](const BoardTag& a, const BoardTag& b) { return a.size_m < b.size_m; });
    return {fmt::format("{} tags of {:g} to {:g} mm", board.tags.size(), 1000 * least->size_m,
                        1000 * most->size_m)};
  }
  for (const BoardTag& tag : board.tags) {
    lines.push_back(
        fmt::format("{} id {}: {:g} mm from edge to edge", tag.family, tag.id, 1000 * tag.size_m));
  }
  return lines;
}

}  // namespace

TargetPrint PrintOf(const TagBoard& board) {
  TargetPrint print;
  const std::vector<PrintedTag> tags = board.Printed();
  for (const PrintedTag& tag : tags) print.shapes.push_back({WholeTag(tag), 1});
  print.board_size_m = 2 * HalfExtent(print);
  for (const PrintedTag& tag : tags) print.shapes.push_back({BlackCells(tag), 0});
  print.dimensions = DimensionLines(board);
  print.dimensions.push_back(
      fmt::format("board: {0:g} x {0:g} mm, white", 1000 * print.board_size_m));
  return print;
}

}  // namespace kestrel
