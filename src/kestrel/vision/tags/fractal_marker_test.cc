// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/fractal_marker.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/vision/tags/test_fractal_marker.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

// The text with one part exchanged.
std::string With(const std::string& part, const std::string& other) {
  std::string text = FractalMarkerText();
  const auto at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return text.replace(at, part.size(), other);
}

TEST(FractalMarkerTest, IsBoardOfNestedTags) {
  const TagBoard board = ParseTagBoard(FractalMarkerText(), "fractal.yml", "tag36h11", 0.6);
  EXPECT_THAT(board.Validate(), IsEmpty());
  ASSERT_EQ(board.tags.size(), 2u);
  EXPECT_EQ(board.tags[0].family, "fractal");
  EXPECT_DOUBLE_EQ(board.tags[0].size_m, 0.6);
  EXPECT_NEAR(board.tags[1].size_m, 0.2, 1e-6);
  const PrintedTag outer = board.Printed()[0];
  const PrintedTag inner = board.Printed()[1];
  EXPECT_DOUBLE_EQ(outer.cell_m, 0.05);
  EXPECT_NEAR(inner.cell_m, 0.025, 1e-6);
  // The margin is white, the border black; the first bits are 0 and 1.
  EXPECT_EQ(outer.grid.at(0, 0), TagCell::kWhite);
  EXPECT_EQ(outer.grid.at(1, 1), TagCell::kBlack);
  EXPECT_EQ(outer.grid.at(2, 2), TagCell::kBlack);
  EXPECT_EQ(outer.grid.at(3, 2), TagCell::kWhite);
}

TEST(FractalMarkerTest, MarkerOmitsCellsCoveredByAnother) {
  const TagBoard board = ParseFractalMarker(FractalMarkerText(), "fractal.yml", 0.6);
  const TagGrid& outer = board.tags[0].own;
  int covered = 0;
  for (int row = 0; row < outer.width; ++row) {
    for (int column = 0; column < outer.width; ++column) {
      const bool inside = row >= 5 && row < 9 && column >= 5 && column < 9;
      EXPECT_EQ(outer.at(column, row) == TagCell::kNone, inside) << column << " " << row;
      covered += inside;
    }
  }
  EXPECT_EQ(covered, 16);
}

TEST(FractalMarkerTest, TakesSizeInMetresFromFile) {
  const TagBoard board =
      ParseFractalMarker(With("mInfoType: 2", "mInfoType: 1"), "fractal.yml", 0.6);
  EXPECT_DOUBLE_EQ(board.tags[0].size_m, 2);
}

TEST(FractalMarkerTest, EachErrorNamesFileLineAndKey) {
  const auto error = [](const std::string& text) {
    return [text] { ParseFractalMarker(text, "fractal.yml", 0.6); };
  };
  EXPECT_THAT(error(With("mInfoType: 2", "mInfoType: 7")),
              ThrowsMessage<InputError>(HasSubstr("fractal.yml:4: mInfoType: is 7, expected 0")));
  EXPECT_THAT(error(With("bits:[ 0, 1,", "bits:[ 0,")),
              ThrowsMessage<InputError>(HasSubstr("has 99 bits, expected a square")));
  EXPECT_THAT(error(With("bits:[ 0, 1,", "bits:[ 0, 2,")),
              ThrowsMessage<InputError>(HasSubstr("is 2, expected 0 or 1")));
  EXPECT_THAT(error(With("[ 1., 1., 0. ], ", "")),
              ThrowsMessage<InputError>(HasSubstr("has 3 corners, expected 4")));
  EXPECT_THAT(error(With("[ 1., 1., 0. ]", "[ 1., 0.5, 0. ]")),
              ThrowsMessage<InputError>(HasSubstr("are not those of an upright square")));
  EXPECT_THAT(error(With("[ 1., 1., 0. ]", "[ 1., .nan, 0. ]")),
              ThrowsMessage<InputError>(HasSubstr("corners")));
  EXPECT_THAT(error(With("submarkers_id:[ 1 ]", "submarkers: [ 1 ]")),
              ThrowsMessage<InputError>(HasSubstr("submarkers")));
}

TEST(FractalMarkerTest, RefusesOrReadsFileTruncatedAnywhere) {
  const std::string text = FractalMarkerText();
  for (std::size_t length = 0; length < text.size(); length += 7) {
    try {
      ParseFractalMarker(text.substr(0, length), "fractal.yml", 0.6);
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace kestrel
