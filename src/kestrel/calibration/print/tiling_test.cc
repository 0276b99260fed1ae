// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/print/tiling.h"

#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

TEST(TilingTest, TilesCoverBoardAndFitSheets) {
  for (const std::string& name : PaperNames()) {
    for (const double board : {0.1, 0.3, 0.75, 1.5, 3.0}) {
      const Tiling tiling = TileBoard(board, *PaperSize(name));
      EXPECT_NEAR(tiling.columns * tiling.tile.x(), board, 1e-9);
      EXPECT_NEAR(tiling.rows * tiling.tile.y(), board, 1e-9);
      const Eigen::Vector2d beyond = tiling.sheet - tiling.tile_on_sheet - tiling.tile;
      EXPECT_GE(tiling.tile_on_sheet.minCoeff(), 0.00999) << name << ' ' << board;
      EXPECT_GE(beyond.minCoeff(), 0.00999) << name << ' ' << board;
    }
  }
}

TEST(TilingTest, TurnsSheetIfThatSavesSheets) {
  EXPECT_EQ(TileBoard(1.5, *PaperSize("a4")).count(), 48);
  const Tiling wide = TileBoard(0.27, *PaperSize("a4"));  // 2 x 1 both ways: stays upright
  EXPECT_EQ(wide.count(), 2);
  EXPECT_LT(wide.sheet.x(), wide.sheet.y());
  for (double board = 0.1; board < 3; board += 0.05) {
    const Tiling tiling = TileBoard(board, *PaperSize("a3"));
    const Eigen::Array2d room = tiling.sheet.reverse().array() - Eigen::Array2d(0.02, 0.025);
    EXPECT_LE(tiling.count(), (board / room).ceil().prod()) << board;
  }
}

TEST(TilingTest, OneSheetHoldsMiddleOfBoard) {
  const auto sheet = OneSheet(0.24, 0.16, *PaperSize("a4"));
  ASSERT_TRUE(sheet);
  EXPECT_EQ(sheet->count(), 1);
  EXPECT_NEAR(sheet->tile.x(), 0.19, 1e-9) << "the white margin is cut off";
  EXPECT_NEAR(sheet->tile.y(), 0.24, 1e-9);
  EXPECT_NEAR(sheet->TileOnBoard(0, 0).x(), 0.025, 1e-9);
  EXPECT_NEAR(sheet->tile_on_sheet.x(), 0.01, 1e-9);
  EXPECT_FALSE(OneSheet(0.3, 0.191, *PaperSize("a4")));
}

TEST(TilingTest, RefusesTooManySheets) {
  EXPECT_THROW(TileBoard(50, *PaperSize("a4")), InputError);
  EXPECT_FALSE(PaperSize("a5"));
}

}  // namespace
}  // namespace kestrel
