// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/follow_simulation.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/io/recording/tables/csv_table.h"
#include "kestrel/io/recording/test_files.h"
#include "kestrel/simulation/recordings/scenarios.h"
#include "kestrel/simulation/recordings/test_plans.h"

namespace kestrel {
namespace {

CameraCalibration SmallFollowCamera() {
  CameraCalibration camera = FollowCalibration();
  camera.intrinsics = {.width_px = 376,
                       .height_px = 240,
                       .fx_px = 268,
                       .fy_px = 268,
                       .cx_px = 187.5,
                       .cy_px = 119.5,
                       .distortion = {}};
  return camera;
}

FollowSimulationOptions SmallFollow(const char* scenario, std::vector<std::string> settings) {
  settings.insert(settings.begin(), {"ground.map_px=256", "rate_hz=5", "frames=50"});
  return ReadFollowSimulation(scenario, "", settings);
}

// Rows of region0/data.csv, or of another one.
struct Rows {
  Rows(const RecordingPlan& plan, const char* file) : text(TextOf(plan, file)), table(text, file) {}

  double Visible(std::size_t row) const {
    return table.Number(row, table.Column("visible_fraction []"));
  }
  cv::Rect2d Box(std::size_t row) const {
    return {table.Number(row, 1), table.Number(row, 2), table.Number(row, 3), table.Number(row, 4)};
  }

  std::string text;
  CsvTable table;
};

TEST(FollowSimulationTest, BoxIsAroundThing) {
  // Without and with the thing's own part of the image: what differs is the thing and its shadow.
  const auto settings = std::vector<std::string>{
      "sensor.read_noise=0",        "sensor.shot_noise=0",  "light.direct=0",
      "navigation.vibration_deg=0", "motion.path=straight", "motion.speed_mps=1"};
  for (const char* scenario : {"person", "car", "boat"}) {
    auto options = SmallFollow(scenario, settings);
    const RecordingPlan plan = PlanFollow(options, SmallFollowCamera(), 4);
    options.thing.kind = scenario == std::string("person") ? "boat" : "person";
    const RecordingPlan other = PlanFollow(options, SmallFollowCamera(), 4);
    const Rows rows(plan, "region0/data.csv"), others(other, "region0/data.csv");
    ASSERT_EQ(rows.table.row_count(), 50u);
    cv::Mat difference;
    cv::absdiff(plan.render(20), other.render(20), difference);
    cv::transform(difference, difference, cv::Matx13f(1, 1, 1));
    const cv::Rect2d both = rows.Box(20) | others.Box(20);
    ASSERT_LT(both.br().y, 235) << "the whole is in the image";
    cv::Mat changed = difference > 12;
    const cv::Rect seen = cv::boundingRect(changed);
    EXPECT_NEAR(seen.x, both.x, 2) << scenario;
    EXPECT_NEAR(seen.y, both.y, 2) << scenario;
    EXPECT_NEAR(seen.br().x, both.br().x, 2) << scenario;
    EXPECT_NEAR(seen.br().y, both.br().y, 2) << scenario;
    EXPECT_GT(rows.Visible(20), 0.99) << scenario;
  }
}

// Seconds for which it is hidden.
double HiddenSeconds(const char* scenario, const char* cover) {
  const RecordingPlan plan =
      PlanFollow(SmallFollow(scenario, {std::string("thing.cover=") + cover, "thing.covered_s=2"}),
                 SmallFollowCamera(), 3);
  const Rows rows(plan, "region0/data.csv");
  int hidden = 0;
  for (std::size_t i = 0; i < rows.table.row_count(); ++i) hidden += rows.Visible(i) < 0.1;
  EXPECT_GT(rows.Visible(0), 0.9);
  EXPECT_GT(rows.Visible(49), 0.9);
  return hidden / 5.0;
}

TEST(FollowSimulationTest, CoverHidesForItsTime) {
  EXPECT_NEAR(HiddenSeconds("person", "tree"), 2, 0.8);
  EXPECT_NEAR(HiddenSeconds("person", "bridge"), 2, 0.8);
  EXPECT_NEAR(HiddenSeconds("car", "bridge"), 2, 0.6);
  EXPECT_NEAR(HiddenSeconds("boat", "bridge"), 2, 1);
  EXPECT_EQ(HiddenSeconds("car", "shade"), 0);
}

TEST(FollowSimulationTest, LookalikePassesCloseAndHasTruthOfItsOwn) {
  const RecordingPlan plan =
      PlanFollow(SmallFollow("person", {"thing.lookalikes=1", "thing.first_crossing_s=5"}),
                 SmallFollowCamera(), 2);
  const Rows rows(plan, "region0/data.csv"), others(plan, "region1/data.csv");
  double nearest_m = 1e9;
  for (std::size_t i = 0; i < rows.table.row_count(); ++i) {
    nearest_m =
        std::min(nearest_m, std::hypot(rows.table.Number(i, 5) - others.table.Number(i, 5),
                                       rows.table.Number(i, 6) - others.table.Number(i, 6)));
  }
  EXPECT_LT(nearest_m, 1.2);
  EXPECT_GT(nearest_m, 0.5);
}

TEST(FollowSimulationTest, LostFramesAreLeftOut) {
  const RecordingPlan plan =
      PlanFollow(SmallFollow("person", {"lost_frames=0.2", "frames=200"}), SmallFollowCamera(), 2);
  EXPECT_NEAR(static_cast<double>(plan.times.size()), 160, 20);
  EXPECT_EQ(Rows(plan, "region0/data.csv").table.row_count(), plan.times.size());
  EXPECT_EQ(plan.render(0).type(), CV_8UC3);
}

TEST(FollowSimulationTest, ThingsDifferBySeed) {
  const auto image = [](std::uint64_t seed) {
    const RecordingPlan plan = PlanFollow(SmallFollow("person", {}), SmallFollowCamera(), seed);
    const cv::Rect box = Rows(plan, "region0/data.csv").Box(0);
    return cv::mean(plan.render(0)(box));
  };
  EXPECT_GT(cv::norm(image(1) - image(2)), 5);
  EXPECT_EQ(image(1), image(1));
}

TEST(FollowSimulationTest, RefusesCoverOverStandingThing) {
  EXPECT_EQ(InputErrorOf([] {
              SmallFollow("person", {"thing.cover=tree", "motion.path=standing"});
            }),
            "thing.cover: expected a thing that moves");
  EXPECT_EQ(InputErrorOf([] { SmallFollow("person", {"thing.kind=none"}); }),
            "thing.kind is 'none', expected a thing");
}

}  // namespace
}  // namespace kestrel
