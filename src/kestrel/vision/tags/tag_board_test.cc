// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/tag_board.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

BoardTag Tag(const std::string& family, int id, double size_m, double x_m = 0, double y_m = 0) {
  BoardTag tag;
  tag.family = family;
  tag.id = id;
  tag.size_m = size_m;
  tag.board_from_tag.translation = {x_m, y_m, 0};
  return tag;
}

TEST(TagBoardTest, SingleTagIsBoard) {
  const TagTargetOptions options;
  EXPECT_THAT(options.ValidateBoard(), IsEmpty());
  const std::vector<PrintedTag> printed = options.Board().Printed();
  ASSERT_EQ(printed.size(), 1u);
  // 36h11: the square is 8 cells wide; y points up, rows down.
  EXPECT_DOUBLE_EQ(printed[0].cell_m, 0.5 / 8);
  EXPECT_TRUE(printed[0].OnBoard(1, 1).isApprox(Eigen::Vector2d(-0.25, 0.25)));
  EXPECT_TRUE(printed[0].OnBoard(9, 9).isApprox(Eigen::Vector2d(0.25, -0.25)));
}

TEST(TagBoardTest, ReadsItsOwnYaml) {
  const TagBoard board = ParseTagBoard(
      "tags:\n"
      "  - {id: 3, size_m: 0.5}\n"
      "  - {family: aruco_4x4_50, id: 7, size_m: 0.1, x_m: 0.5, y_m: -0.1, yaw_deg: 90, "
      "inverted: true, over: true}\n",
      "board.yaml", "tag36h11", 0.5);
  ASSERT_EQ(board.tags.size(), 2u);
  EXPECT_EQ(board.tags[0].family, "tag36h11");
  EXPECT_EQ(board.tags[1].family, "aruco_4x4_50");
  EXPECT_TRUE(board.tags[1].inverted);
  EXPECT_TRUE(board.tags[1].over);
  EXPECT_NEAR(HeadingOf(board.tags[1].board_from_tag.rotation), kPi / 2, 1e-12);
  // The upper left corner of the square is turned with the tag.
  const PrintedTag printed = board.Printed()[1];
  EXPECT_TRUE(printed.OnBoard(1, 1).isApprox(Eigen::Vector2d(0.5 - 0.05, -0.1 - 0.05), 1e-9));
  EXPECT_EQ(printed.grid.at(1, 1), TagCell::kWhite);
}

TEST(TagBoardTest, ReadsBundleOfApriltagRos) {
  const std::string yaml =
      "standalone_tags: []\n"
      "tag_bundles:\n"
      "  [\n"
      "    {name: 'pad', layout: [\n"
      "      {id: 10, size: 0.05, x: 0, y: 0, z: 0, qw: 1, qx: 0, qy: 0, qz: 0},\n"
      "      {id: 1, size: 0.2, x: -0.3, y: 0.1, z: 0, qw: 0, qx: 0, qy: 0, qz: 1}]}\n"
      "  ]\n";
  const TagBoard board = ParseTagBoard(yaml, "tags.yaml", "tag36h11", 0.5);
  EXPECT_THAT(board.Validate(), IsEmpty());
  ASSERT_EQ(board.tags.size(), 2u);
  EXPECT_EQ(board.tags[1].id, 1);
  EXPECT_EQ(board.tags[1].size_m, 0.2);
  EXPECT_TRUE(board.tags[1].board_from_tag.translation.isApprox(Eigen::Vector3d(-0.3, 0.1, 0)));
  EXPECT_NEAR(std::abs(HeadingOf(board.tags[1].board_from_tag.rotation)), kPi, 1e-12);
  EXPECT_THAT([] { ParseTagBoard("tag_bundles: []\n", "tags.yaml", "tag36h11", 0.5); },
              ThrowsMessage<InputError>(HasSubstr("has 0 bundles, expected one")));
}

TEST(TagBoardTest, FileErrorsNameKey) {
  EXPECT_THAT([] { ParseTagBoard("tags:\n  - {id: 3, size: 0.5}\n", "b.yaml", "tag36h11", 0.5); },
              ThrowsMessage<InputError>(HasSubstr("unknown key 'size'")));
  TagTargetOptions options;
  options.board = "/nowhere/board.yaml";
  EXPECT_THAT(options.ValidateBoard(), ElementsAre(HasSubstr("/nowhere/board.yaml")));
}

TEST(TagBoardTest, RefusesFilesWithoutBoardWithAdvice) {
  const auto refusal = [](const std::string& yaml) {
    return InputErrorOf([&] { ParseTagBoard(yaml, "/a/tags.yaml", "tag36h11", 0.5); });
  };
  for (const char* yaml : {"standalone_tags: [{id: 7, size: 0.3}]\ntag_bundles: []\n",
                           "standalone_tags: [{id: 7, size: 0.3}]\n",
                           "/**:\n  ros__parameters:\n    family: 36h11\n    tag: {ids: [7]}\n"}) {
    EXPECT_THAT(refusal(yaml),
                AllOf(StartsWith("/a/tags.yaml:"), HasSubstr("--target-id"), HasSubstr("size_m")))
        << yaml;
  }
}

TEST(TagBoardTest, FileViolationsNameExistingPath) {
  const TestFolder folder;
  TagTargetOptions options;
  options.board = folder.Write("board.yaml", "tags:\n  - {id: 7, size: 0.3}\n");
  EXPECT_THAT(options.ValidateBoard(), ElementsAre(StartsWith("board: " + options.board + ":2: ")));
  options.board = folder.Write("board.yaml", "tags:\n  - {id: 7, size_m: 300}\n");
  EXPECT_THAT(options.ValidateBoard(),
              ElementsAre(StartsWith("board: " + options.board + ": tag36h11")));
}

TEST(TagBoardTest, ReportsEachViolationInOneLine) {
  EXPECT_THAT(TagBoard().Validate(), ElementsAre("the board has no tag"));
  EXPECT_THAT((TagBoard{{Tag("tag36h11", 3, 0.5), Tag("tag36h11", 3, 0.1, 2)}}).Validate(),
              ElementsAre("tag36h11 id 3 is on the board twice"));
  EXPECT_THAT((TagBoard{{Tag("tag36h12", 3, 0.5)}}).Validate(),
              ElementsAre("unknown family of tags 'tag36h12', did you mean 'tag36h11'?"));
  EXPECT_THAT((TagBoard{{Tag("tag36h11", 3, 500)}}).Validate(),
              ElementsAre("tag36h11 id 3: size_m is 500, expected metres: 0.5?"));
  EXPECT_THAT((TagBoard{{Tag("tag36h11", 3, 0)}}).Validate(),
              ElementsAre("tag36h11 id 3: size_m is 0, expected more than 0"));
}

TEST(TagBoardTest, RequiresTagInPlane) {
  BoardTag high = Tag("tag36h11", 3, 0.5);
  high.board_from_tag.translation.z() = 0.1;
  EXPECT_THAT((TagBoard{{high}}).Validate(),
              ElementsAre("tag36h11 id 3 is not in the plane of the board: z is 0.1 m"));
  BoardTag tilted = Tag("tag36h11", 3, 0.5);
  tilted.board_from_tag.rotation = Eigen::AngleAxisd(Radians(90), Eigen::Vector3d::UnitX());
  EXPECT_THAT((TagBoard{{tilted}}).Validate(), ElementsAre(HasSubstr("it is tilted by 90.0 deg")));
}

TEST(TagBoardTest, RefusesUndeclaredOverlaps) {
  const BoardTag large = Tag("tag36h11", 0, 0.8);
  BoardTag small = Tag("tag36h11", 1, 0.05, 0.1, 0.1);
  EXPECT_THAT((TagBoard{{large, small}}).Validate(),
              ElementsAre(HasSubstr("tag36h11 id 0 and tag36h11 id 1 overlap")));
  small.over = true;
  const TagBoard board{{large, small}};
  EXPECT_THAT(board.Validate(), IsEmpty());
  // The large tag does without the cells that are covered; the small one has all.
  const std::vector<PrintedTag> printed = board.Printed();
  const auto empty = [](const PrintedTag& tag) {
    return std::count(tag.grid.cells.begin(), tag.grid.cells.end(), TagCell::kNone);
  };
  EXPECT_GE(empty(printed[0]), 1);
  EXPECT_LE(empty(printed[0]), 4);
  EXPECT_EQ(empty(printed[1]), 0);
}

TEST(TagBoardTest, TagFitsIntoEmptyCentre) {
  // tagCustom48h12 has an empty centre of 2 x 2 cells; its square is 6 cells wide.
  const BoardTag large = Tag("tagCustom48h12", 0, 0.6);
  EXPECT_THAT((TagBoard{{large, Tag("tag36h11", 1, 0.15)}}).Validate(), IsEmpty());
  EXPECT_THAT((TagBoard{{large, Tag("tag36h11", 1, 0.3)}}).Validate(),
              ElementsAre(HasSubstr("overlap")));
  // White margins may share their place.
  EXPECT_THAT((TagBoard{{Tag("tag36h11", 0, 0.8), Tag("tag36h11", 1, 0.8, 0.9)}}).Validate(),
              IsEmpty());
  EXPECT_THAT((TagBoard{{Tag("tag36h11", 0, 0.8), Tag("tag36h11", 1, 0.8, 0.85)}}).Validate(),
              ElementsAre(HasSubstr("overlap")));
}

}  // namespace
}  // namespace kestrel
