// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/object_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/evaluation/matching.h"
#include "kestrel/app/evaluation/object_tables.h"
#include "kestrel/app/evaluation/test_flight.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const TrueObjects kObjects = {{1, {"red", 0.2, "cuboid", 9}},
                              {2, {"blue", 0.2, "disc", {}}},
                              {3, {"yellow", 0.2, "disc", {}}}};

// A sighting x metres north of the origin, for the camera of TestFlight.
TrueSighting Sighting(int id, double x, double visible = 1) {
  return {FrameTime(0), id, {x, 0, 0}, {0, 0, 0}, {320, 240 - 100 * x}, visible};
}

ObjectRow Detection(const std::string& class_name, const Eigen::Vector2d& center_px) {
  return {FrameTime(0), center_px, 10, class_name, 0.9, "disc", {}, Eigen::Vector3d(0, 0, 5), {}};
}

ObjectRow Merged(const std::string& class_name, const Eigen::Vector2d& center_px) {
  return {FrameTime(0), center_px, 30, class_name, 0.9, "merged", {}, {}, {}};
}

TEST(MatchNearest, MatchesEachObjectOnce) {
  const auto matches = MatchNearest({{0, 0, 3}, {0, 1, 1}, {1, 1, 2}, {1, 0, 4}});
  ASSERT_EQ(matches.size(), 2u);
  EXPECT_EQ(matches[0].second, 1);
  EXPECT_EQ(matches[1].first, 1);
  EXPECT_EQ(matches[1].second, 0);
}

TEST(CompareObjects, DistinguishesFoundMissedFalseAndMisclassified) {
  const TestFlight files;
  const FlightTruth flight(files.recording());
  const ObjectRows rows = {{FrameTime(0)},
                           {Detection("red", {320, 241}), Detection("green", {323, 144}),
                            Detection("orange", {30, 30})}};
  const auto comparisons = CompareObjects(
      flight, kObjects, {Sighting(1, 0), Sighting(2, 1), Sighting(3, 2, 0.4)}, rows, "file");
  ASSERT_EQ(comparisons.size(), 4u);
  EXPECT_EQ(comparisons[0].detected_class, "red");
  EXPECT_TRUE(comparisons[0].is_wanted);  // 20 px in diameter
  EXPECT_NEAR(comparisons[0].center_error_px, 1, 1e-9);
  EXPECT_EQ(comparisons[1].detected_class, "green");
  EXPECT_NEAR(comparisons[1].center_error_px, 5, 1e-9);
  EXPECT_FALSE(comparisons[2].IsDetected());
  EXPECT_FALSE(comparisons[2].is_wanted);
  EXPECT_FALSE(comparisons[3].IsObject());

  const ReportTable table = DetectionTable(comparisons);
  const auto& all = table.rows.back();
  EXPECT_THAT(
      std::vector(all.begin(), all.begin() + 10),
      ElementsAre("all", "2", "2", "100.0", "34.2 to 100.0", "3", "1", "66.7", "50.0", "50.0"));
  EXPECT_THAT(ConfusionTable(comparisons).rows,
              ElementsAre(ElementsAre("blue", "1", "0"), ElementsAre("red", "0", "1")));
}

TEST(CompareObjects, AcceptsMergedOnlyAtTrueDiscs) {
  const TestFlight files;
  const FlightTruth flight(files.recording());
  const TrueObjects discs = {{1, {"red", 0.2, "disc", {}}}, {2, {"red", 0.2, "disc", {}}}};
  const ObjectRows rows = {
      {FrameTime(0)},
      {Merged("red", {320, 230}), Merged("blue", {320, 230}), Merged("red", {100, 100})}};
  const auto comparisons =
      CompareObjects(flight, discs, {Sighting(1, 0), Sighting(2, 0.2)}, rows, "file");
  ASSERT_EQ(comparisons.size(), 4u);
  EXPECT_FALSE(comparisons[0].IsDetected()) << "it touches another one, nobody says where it is";
  EXPECT_EQ(comparisons[2].detected_class, "blue") << "red ones are there";
  EXPECT_FALSE(comparisons[2].IsObject());
  EXPECT_FALSE(comparisons[3].IsObject());
}

TEST(ParseObjectRows, RequiresShapeAndPositionExceptForMerged) {
  const std::string header =
      "frame,timestamp_ns,u_px,v_px,semi_major_px,class,class_probability,p_CO_C_x_m,p_CO_C_y_m,"
      "p_CO_C_z_m,p_WO_W_x_m,p_WO_W_y_m,p_WO_W_z_m,shape,digit,digit_probability\n";
  const auto parse = [&](const std::string& row) {
    return ParseObjectRows(header + "a,5,1,2,3,red,0.9," + row, "rows.csv");
  };
  EXPECT_EQ(parse("0,0,4,,,,cuboid,7,0.8\n").objects[0].digit->digit, 7);
  EXPECT_EQ(parse(",,,,,,merged,,\n").objects[0].shape, "merged");
  EXPECT_THAT(InputErrorOf([&] { parse(",,,,,,disc,,\n"); }),
              HasSubstr("rows.csv: line 2: a disc without a position"));
  EXPECT_THAT(InputErrorOf([&] { parse("0,0,4,,,,square,,\n"); }),
              HasSubstr("shape 'square', expected disc, cuboid, bar, merged"));
}

TEST(CompareMap, ReportsMissingAndFalseObjects) {
  std::vector<TrueSighting> sightings = {Sighting(1, 0), Sighting(2, 1), Sighting(3, 2)};
  sightings[2].velocity_in_world = {0, 1, 0};
  std::vector<ObjectComparison> comparisons;
  for (const int id : {1, 2, 3, 1, 2, 3, 1, 2, 3}) {
    comparisons.emplace_back().true_id = id;
    comparisons.back().is_wanted = true;
  }
  const Time later = FrameTime(0) + DurationFromSeconds(2);
  const std::vector<MapRow> rows = {
      {1, "red", "cuboid", ReportedDigit{6, 0.5}, {0.3, 0.4, 0}, {0, 0, 0}, FrameTime(0)},
      {2, "yellow", "cuboid", {}, {2, 2, 0}, {0, 1, 0.5}, later},
      {3, "red", "disc", {}, {9, 9, 0}, {0, 0, 0}, FrameTime(0)}};
  const auto map = CompareMap(kObjects, sightings, comparisons, rows);
  ASSERT_EQ(map.size(), 4u);
  EXPECT_EQ(map[0].true_class, "yellow");  // tracked to its last place
  EXPECT_NEAR(map[0].position_error_m, 0, 1e-9);
  EXPECT_NEAR(map[0].velocity_error_mps, 0.5, 1e-9);
  EXPECT_NEAR(map[1].position_error_m, 0.5, 1e-9);
  EXPECT_THAT(MapTable(map).rows,
              ElementsAre(ElementsAre("3", "2", "66.7", "3", "1", "66.7", "100.0", "50.0", "1", "1",
                                      "0.250", "0.500", "0.500")));
}

TEST(ParseTrueSightings, RefusesUnlistedObject) {
  const std::string text =
      "#timestamp [ns],id [],p_WO_W_x [m],p_WO_W_y [m],p_WO_W_z [m],v_WO_W_x [m s^-1],v_WO_W_y [m "
      "s^-1],v_WO_W_z [m s^-1],u [px],v [px],visible_fraction []\n5,8,0,0,0,0,0,0,1,1,1\n";
  EXPECT_THAT(InputErrorOf([&] { ParseTrueSightings(text, "data.csv", kObjects); }),
              HasSubstr("data.csv: line 2: id 8, expected one of objects.csv"));
}

}  // namespace
}  // namespace kestrel
