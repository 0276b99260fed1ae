// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/plain_tags.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/vision/tags/test_fractal_marker.h"

namespace kestrel {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

TagBoard BoardOf(const std::string& family, int id) {
  BoardTag tag;
  tag.family = family;
  tag.id = id;
  return {{tag}};
}

TEST(PlainTagsTest, WarnsOfPlainTagsAndSuggestsBetterIds) {
  EXPECT_THAT(WarningsOfPlainTags(BoardOf("aruco_original", 0)),
              ElementsAre(AllOf(StartsWith("aruco_original id 0 is as plain as a window"),
                                HasSubstr("; ids that are told apart: "))));
  EXPECT_THAT(WarningsOfPlainTags(BoardOf("aruco_original", 1023)),
              ElementsAre(HasSubstr("id 1023 is as plain")));
  EXPECT_THAT(WarningsOfPlainTags(BoardOf("aruco_4x4_50", 17)),
              ElementsAre(HasSubstr("id 17 is as plain")));
  TagBoard inverted = BoardOf("aruco_4x4_50", 17);
  inverted.tags[0].inverted = true;
  EXPECT_THAT(WarningsOfPlainTags(inverted), ElementsAre(HasSubstr("id 17 is as plain")));
}

TEST(PlainTagsTest, DoesNotWarnOfOtherIds) {
  for (int id = 0; id < 50; ++id) {
    if (id == 17) continue;
    EXPECT_THAT(WarningsOfPlainTags(BoardOf("aruco_4x4_50", id)), IsEmpty()) << id;
  }
  for (const std::string& family : TagFamily::Names()) {
    EXPECT_THAT(WarningsOfPlainTags(BoardOf(family, 7)), IsEmpty()) << family;
  }
}

TEST(PlainTagsTest, WarnsOfMarkerWithoutFamilyWithoutOtherIds) {
  TagBoard board = ParseTagBoard(FractalMarkerText(), "fractal.yml", "", 0.6);
  EXPECT_THAT(WarningsOfPlainTags(board), IsEmpty());
  BoardTag block = BoardOf("fractal", 3).tags[0];
  block.own = SquareTag(4, {false, false, false, false, false, true, true, false,  //
                            false, true, true, false, false, false, false, false});
  EXPECT_THAT(WarningsOfPlainTags({{block}}),
              ElementsAre(AllOf(StartsWith("fractal id 3 is as plain"), Not(HasSubstr("; ids")))));
}

}  // namespace
}  // namespace kestrel
