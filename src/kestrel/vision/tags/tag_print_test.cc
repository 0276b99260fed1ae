// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/tag_print.h"

#include <variant>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

using Eigen::Vector2d;

// Returns the number of times that the lines go around the point, clockwise.
int Turns(const PrintPolygon& polygon, const Vector2d& point) {
  int turns = 0;
  for (const auto& loop : polygon.loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vector2d a = loop[i] - point;
      const Vector2d b = loop[(i + 1) % loop.size()] - point;
      if ((a.y() > 0) == (b.y() > 0)) continue;
      const double at_x = a.x() - a.y() * (b.x() - a.x()) / (b.y() - a.y());
      if (at_x > 0) turns += a.y() > 0 ? 1 : -1;
    }
  }
  return turns;
}

TagBoard BoardOf(const std::string& family, bool inverted = false) {
  BoardTag tag;
  tag.family = family;
  tag.id = 7;
  tag.inverted = inverted;
  tag.board_from_tag.translation = {0.3, -0.2, 0};
  return {{tag}};
}

TEST(TagPrint, AreaEqualsBlackCells) {
  for (const std::string& family : TagFamily::Names()) {
    for (const bool inverted : {false, true}) {
      const TagBoard board = BoardOf(family, inverted);
      const PrintedTag tag = board.Printed().at(0);
      const TargetPrint print = PrintOf(board);
      ASSERT_EQ(print.shapes.size(), 2u);
      EXPECT_EQ(print.shapes[0].gray, 1);
      EXPECT_EQ(print.shapes[1].gray, 0);
      const auto& black = std::get<PrintPolygon>(print.shapes[1].area);
      for (int row = 0; row < tag.grid.width; ++row) {
        for (int column = 0; column < tag.grid.width; ++column) {
          const int expected = tag.grid.at(column, row) == TagCell::kBlack ? 1 : 0;
          ASSERT_EQ(Turns(black, tag.OnBoard(column + 0.5, row + 0.5)), expected)
              << family << " at column " << column << ", row " << row;
        }
      }
    }
  }
}

TEST(TagPrint, OutlineHasNoCollinearCorners) {
  const TargetPrint print = PrintOf(BoardOf("tag36h11"));
  for (const auto& loop : std::get<PrintPolygon>(print.shapes[1].area).loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vector2d before = loop[i] - loop[(i + loop.size() - 1) % loop.size()];
      const Vector2d after = loop[(i + 1) % loop.size()] - loop[i];
      EXPECT_GT(std::abs(before.x() * after.y() - before.y() * after.x()), 1e-6);
    }
  }
}

TEST(TagPrint, BoardHoldsTagWithMargin) {
  const TagBoard board = BoardOf("tag36h11");
  // 0.5 m are 8 cells of the 10 with the margin.
  EXPECT_NEAR(PrintOf(board).board_size_m, 2 * (0.3 + 5 * 0.5 / 8), 1e-12);
}

TEST(TagPrint, ListsFewTagsAndCountsMany) {
  TagBoard board = BoardOf("tag36h11");
  EXPECT_EQ(PrintOf(board).dimensions.at(0), "tag36h11 id 7: 500 mm from edge to edge");
  for (int i = 0; i < 5; ++i) {
    board.tags.push_back(board.tags[0]);
    board.tags.back().id = i;
    board.tags.back().size_m = 0.1;
    board.tags.back().board_from_tag.translation.x() += 0.6 + 0.2 * i;
  }
  EXPECT_EQ(PrintOf(board).dimensions.at(0), "6 tags of 100 to 500 mm");
}

}  // namespace
}  // namespace kestrel
