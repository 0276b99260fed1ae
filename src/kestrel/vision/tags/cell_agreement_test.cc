// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/cell_agreement.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/vision/tags/board_model.h"
#include "kestrel/vision/tags/test_tag_images.h"

namespace kestrel {
namespace {

constexpr double kWhiteGray = 190, kBlackGray = 14, kCellPx = 20;
constexpr double kEnough = 8.9;  // evidence that a search needs in an image with few quads
constexpr double kEnoughFollowed = 4.9;
constexpr int kSeeds = 50;

TagModel ModelOf(int id) { return BoardModel(BoardOfTag("aruco_4x4_50", id, 1)).tags.front(); }

// A print in a light that a bar dims: some columns or rows of the grid, its edge among them.
std::vector<float> GraysUnderBar(const TagGrid& print, double light, std::uint64_t seed) {
  Random random(seed);
  const bool across = random.Chance(0.5);
  const int width = random.Integer(1, 2);
  const int first = random.Integer(0, print.width - width);
  std::vector<float> gray;
  for (int row = 0; row < print.width; ++row) {
    for (int column = 0; column < print.width; ++column) {
      const int place = across ? row : column;
      const bool dim = place >= first && place < first + width;
      const double ink = print.at(column, row) == TagCell::kWhite ? kWhiteGray : kBlackGray;
      gray.push_back(static_cast<float>((dim ? light : 1) * ink + random.Normal()));
    }
  }
  return gray;
}

TagAgreement Compare(const TagModel& tag, const std::vector<float>& gray, DimSample dim) {
  return CompareCells(tag.grid(), tag.is_data, kCellPx, gray, dim);
}

class CellAgreementTest : public testing::Test {
 protected:
  static constexpr double kLight = 0.15;  // in the shadow

  // A detector reports a tag of this agreement.
  bool IsTaken(const std::vector<float>& gray, DimSample dim) const {
    const TagAgreement agreement = Compare(tag_, gray, dim);
    const double enough = dim == DimSample::kWrong ? kEnough : kEnoughFollowed;
    return agreement.wrong <= tag_.most_wrong && agreement.evidence > enough;
  }

  std::vector<std::size_t> DataCells(TagCell color) const {
    std::vector<std::size_t> cells;
    for (std::size_t i = 0; i < tag_.cell_count(); ++i) {
      if (tag_.is_data[i] && tag_.grid().cells[i] == color) cells.push_back(i);
    }
    return cells;
  }

  // The tag's print with the other color in one cell.
  TagGrid WithOther(std::size_t cell) const {
    TagGrid print = tag_.grid();
    const bool is_white = print.cells[cell] == TagCell::kWhite;
    print.cells[cell] = is_white ? TagCell::kBlack : TagCell::kWhite;
    return print;
  }

  TagModel tag_ = ModelOf(0);
};

TEST_F(CellAgreementTest, SearchReadsTagUnderBarOfShadow) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    EXPECT_TRUE(IsTaken(GraysUnderBar(tag_.grid(), kLight, seed), DimSample::kWrong)) << seed;
  }
}

TEST_F(CellAgreementTest, OtherIdsAreNotTakenUnderBarOfShadow) {
  for (int id = 1; id < 50; ++id) {
    const std::vector<float> gray = GraysUnderBar(ModelOf(id).grid(), kLight, id);
    EXPECT_FALSE(IsTaken(gray, DimSample::kWrong)) << id;
    EXPECT_FALSE(IsTaken(gray, DimSample::kUnknown)) << id;
  }
}

// A black cell in the sun may pass for white where nearly all cells around it are in the shadow.
TEST_F(CellAgreementTest, BlackCellPrintedForWhiteIsHardlyEverFoundUnderBarOfShadow) {
  int tried = 0, taken = 0;
  for (const std::size_t cell : DataCells(TagCell::kWhite)) {
    for (int seed = 0; seed < kSeeds; ++seed) {
      ++tried;
      taken += IsTaken(GraysUnderBar(WithOther(cell), kLight, seed), DimSample::kWrong);
    }
  }
  EXPECT_LE(taken, 0.01 * tried);
}

TEST_F(CellAgreementTest, BlankSquareIsNotTakenUnderBarOfShadow) {
  TagGrid blank = tag_.grid();
  for (const std::size_t cell : DataCells(TagCell::kWhite)) blank.cells[cell] = TagCell::kBlack;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const std::vector<float> gray = GraysUnderBar(blank, kLight, seed);
    EXPECT_FALSE(IsTaken(gray, DimSample::kWrong)) << seed;
    EXPECT_FALSE(IsTaken(gray, DimSample::kUnknown)) << seed;
  }
}

// A gray cell is another print where no shadow falls on the white square.
TEST_F(CellAgreementTest, GrayCellInEvenLightIsWrong) {
  std::vector<float> gray;
  for (const TagCell cell : tag_.grid().cells) {
    gray.push_back(cell == TagCell::kWhite ? kWhiteGray : kBlackGray);
  }
  for (const std::size_t cell : DataCells(TagCell::kWhite)) {
    const float before = gray[cell];
    gray[cell] = kLight * kWhiteGray;
    EXPECT_EQ(Compare(tag_, gray, DimSample::kWrong).wrong, 1) << cell;
    gray[cell] = before;
  }
}

}  // namespace
}  // namespace kestrel
