// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/hunt_simulation.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "kestrel/io/recording/tables/csv_table.h"
#include "kestrel/io/recording/test_files.h"
#include "kestrel/simulation/recordings/scenarios.h"
#include "kestrel/simulation/recordings/test_plans.h"

namespace kestrel {
namespace {

CameraCalibration SmallHuntCamera() {
  CameraCalibration camera = HuntCalibration();
  camera.intrinsics = {.width_px = 320,
                       .height_px = 180,
                       .fx_px = 200,
                       .fy_px = 200,
                       .cx_px = 160,
                       .cy_px = 90,
                       .distortion_model = DistortionModel::kRadialTangential,
                       .distortion = {-0.3, 0.1, 0.0005, -0.0003}};
  return camera;
}

HuntSimulationOptions Small(const char* scenario, std::vector<std::string> settings) {
  settings.insert(settings.end(), {"ground.map_px=256", "rate_hz=2"});
  return ReadHuntSimulation(scenario, "", settings);
}

// Returns the centre of the pixels that are more red than green and blue, within 'reach_px' of
// 'near'.
Eigen::Vector2d RedCenter(const cv::Mat& image, const Eigen::Vector2d& near, double reach_px) {
  Eigen::Vector2d sum(0, 0);
  double weights = 0;
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      if ((Eigen::Vector2d(u, v) - near).norm() > reach_px) continue;
      const auto& pixel = image.at<cv::Vec3b>(v, u);
      const double weight = std::max(pixel[2] - std::max(pixel[0], pixel[1]) - 25, 0);
      sum += weight * Eigen::Vector2d(u, v);
      weights += weight;
    }
  }
  return sum / weights;
}

TEST(HuntSimulationTest, ObjectsMatchTruthWithRollingShutterAndVibration) {
  // A fast, shaking flight over only large red discs.
  const RecordingPlan plan = PlanHunt(
      Small("sweep", {"frames=24", "objects.size_m=0.5", "objects.red=14", "objects.green=0",
                      "objects.blue=0", "objects.yellow=0", "objects.orange=0",
                      "objects.orange_bars=0", "objects.distractors=0", "banners=0", "vehicles=0",
                      "navigation.vibration_deg=0.1", "ground.shadows=false", "uav_shadow=false",
                      "objects.gloss=0", "sensor.jpeg_quality=100"}),
      SmallHuntCamera(), 5);
  const std::string text = TextOf(plan, "objects0/data.csv");
  const CsvTable rows(text, "objects");
  int seen = 0;
  for (std::size_t row = 0; row < rows.row_count(); ++row) {
    const auto index = std::distance(
        plan.times.begin(),
        std::find(plan.times.begin(), plan.times.end(), TimeFromNanoseconds(rows.Integer(row, 0))));
    if (rows.Number(row, rows.Column("visible_fraction []")) < 1) continue;
    const Eigen::Vector2d pixel(rows.Number(row, rows.Column("u [px]")),
                                rows.Number(row, rows.Column("v [px]")));
    const cv::Mat image = plan.render(index);
    EXPECT_LT((RedCenter(image, pixel, 14) - pixel).norm(), 0.3) << "row " << row;
    ++seen;
  }
  EXPECT_GT(seen, 5);
}

TEST(HuntSimulationTest, CuboidsHaveDigits) {
  const RecordingPlan plan = PlanHunt(Small("cuboids", {"frames=3"}), SmallHuntCamera(), 2);
  const std::string digits_text = TextOf(plan, "objects0/digits.csv");
  const std::string objects_text = TextOf(plan, "objects0/objects.csv");
  const CsvTable digits(digits_text, "digits");
  const CsvTable objects(objects_text, "objects");
  EXPECT_EQ(digits.row_count(), 20u);
  ASSERT_EQ(objects.row_count(), 20u);
  std::set<std::int64_t> seen;
  for (std::size_t row = 0; row < 20; ++row) {
    seen.insert(digits.Integer(row, 1));
    EXPECT_EQ(objects.Text(row, 3), "cuboid");
  }
  EXPECT_EQ(seen.size(), 10u) << "all digits";
  EXPECT_EQ(plan.render(0).type(), CV_8UC3);
}

TEST(HuntSimulationTest, OnlyYellowMoves) {
  const RecordingPlan plan =
      PlanHunt(Small("sweep", {"frames=60", "objects.yellow=6"}), SmallHuntCamera(), 2);
  const std::string objects_text = TextOf(plan, "objects0/objects.csv");
  const std::string rows_text = TextOf(plan, "objects0/data.csv");
  const CsvTable objects(objects_text, "objects");
  const CsvTable rows(rows_text, "rows");
  int moving = 0;
  for (std::size_t row = 0; row < rows.row_count(); ++row) {
    const Eigen::Vector2d velocity(rows.Number(row, 5), rows.Number(row, 6));
    const bool is_yellow = objects.Text(rows.Integer(row, 1) - 1, 1) == "yellow";
    if (!is_yellow) {
      EXPECT_EQ(velocity.norm(), 0);
    }
    moving += is_yellow && velocity.norm() > 0.05;
  }
  EXPECT_GT(moving, 3);
}

TEST(HuntSimulationTest, DescentEndsOverFirstObject) {
  const RecordingPlan plan = PlanHunt(Small("descend", {"frames=20"}), SmallHuntCamera(), 2);
  const std::string text = TextOf(plan, "objects0/data.csv");
  const CsvTable rows(text, "objects");
  const std::size_t last = rows.row_count() - 1;
  EXPECT_EQ(rows.Integer(last, 0), ToNanoseconds(plan.times.back()));
  bool seen = false;
  for (std::size_t row = 0; row <= last; ++row) {
    seen = seen ||
           (rows.Integer(row, 0) == ToNanoseconds(plan.times.back()) && rows.Integer(row, 1) == 1);
  }
  EXPECT_TRUE(seen);
}

// Returns the position of each object from the rows.
std::map<std::int64_t, std::string> Positions(const RecordingPlan& plan) {
  const std::string text = TextOf(plan, "objects0/data.csv");
  const CsvTable rows(text, "objects");
  std::map<std::int64_t, std::string> positions;
  for (std::size_t row = 0; row < rows.row_count(); ++row) {
    positions[rows.Integer(row, 1)] = std::string(rows.Text(row, 2)) + ' ' +
                                      std::string(rows.Text(row, 3)) + ' ' +
                                      std::string(rows.Text(row, 4));
  }
  return positions;
}

TEST(HuntSimulationTest, UavsOfTeamShareField) {
  const auto plan = [](std::uint64_t seed, const char* first_lane) {
    return PlanHunt(Small("sweep", {"frames=60", "field_seed=7", "objects.yellow=0", first_lane}),
                    SmallHuntCamera(), seed);
  };
  const RecordingPlan first = plan(1, "flight.first_lane=0");
  const RecordingPlan second = plan(2, "flight.first_lane=1");
  EXPECT_EQ(TextOf(first, "objects0/objects.csv"), TextOf(second, "objects0/objects.csv"));
  EXPECT_NE(TextOf(first, "objects0/data.csv"), TextOf(second, "objects0/data.csv"));
  const auto seen_by_first = Positions(first);
  int seen_by_both = 0;
  for (const auto& [id, position] : Positions(second)) {
    const auto found = seen_by_first.find(id);
    if (found == seen_by_first.end()) continue;
    EXPECT_EQ(found->second, position) << id;
    ++seen_by_both;
  }
  EXPECT_GT(seen_by_both, 2);
}

TEST(HuntSimulationTest, RefusesUnflyableOptions) {
  EXPECT_EQ(InputErrorOf([] {
              Small("descend", {"objects.red=0", "objects.green=0", "objects.blue=0",
                                "objects.yellow=0", "objects.orange=0", "objects.orange_bars=0"});
            }),
            "flight.path is descend, expected at least one object");
  EXPECT_EQ(InputErrorOf([] { Small("sweep", {"zoom.rate_hz=10"}); }),
            "zoom.rate_hz is more than 0, expected 0: here the lens is fixed");
  EXPECT_EQ(InputErrorOf([] { Small("sweep", {"objects.size_m=-0.2"}); }),
            "objects.size_m is -0.2, expected 0.02 to 2");
}

}  // namespace
}  // namespace kestrel
