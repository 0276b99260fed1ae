// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/landing_simulation.h"

#include <atomic>
#include <filesystem>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/read_file.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"
#include "kestrel/io/recording/tables/csv_table.h"
#include "kestrel/io/recording/test_files.h"
#include "kestrel/simulation/recordings/scenarios.h"
#include "kestrel/simulation/recordings/test_plans.h"
#include "kestrel/simulation/rendering/test_worlds.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

// Few and small images, for speed.
LandingSimulationOptions SmallFlight() {
  return ReadLandingSimulation("figure8", "",
                               {"frames=4", "rate_hz=0.5", "ground.map_px=256",
                                "navigation.mount_error_deg=0", "shutter.rays_per_pixel=2"});
}

CameraCalibration SmallCamera() {
  CameraCalibration camera = PaperCalibration();
  camera.intrinsics = SmallFisheye();
  return camera;
}

// Returns the rows of a CSV text by the time in their first column.
std::map<std::int64_t, std::size_t> RowsByTime(const CsvTable& table) {
  std::map<std::int64_t, std::size_t> rows;
  for (std::size_t row = 0; row < table.row_count(); ++row) rows[table.Integer(row, 0)] = row;
  return rows;
}

RigidTransform PoseIn(const CsvTable& table, std::size_t row) {
  const auto number = [&](int column) { return table.Number(row, column); };
  return {Eigen::Quaterniond(number(4), number(5), number(6), number(7)).normalized(),
          {number(1), number(2), number(3)}};
}

TEST(LandingSimulationTest, TruthOfPatternAndBodyIsConsistent) {
  const CameraCalibration camera = SmallCamera();
  const RecordingPlan plan = PlanLanding(SmallFlight(), camera, 7);
  const CsvTable pattern(TextOf(plan, "landing_pattern0/data.csv"), "pattern");
  const CsvTable state(TextOf(plan, "state_groundtruth_estimate0/data.csv"), "state");
  const auto states = RowsByTime(state);
  const CameraModel model(camera.intrinsics);
  ASSERT_EQ(pattern.row_count(), plan.times.size());
  for (std::size_t row = 0; row < pattern.row_count(); ++row) {
    EXPECT_EQ(pattern.Integer(row, 0), ToNanoseconds(plan.times[row]));
    const RigidTransform world_from_camera =
        PoseIn(state, states.at(pattern.Integer(row, 0))) * *camera.body_from_camera;
    const RigidTransform world_from_pattern = PoseIn(pattern, row);
    Eigen::Vector2d pixel;
    model.Project(world_from_camera.Inverse() * world_from_pattern.translation, &pixel);
    EXPECT_NEAR(pixel.x(), pattern.Number(row, pattern.Column("u [px]")), 1e-3);
    EXPECT_NEAR(pixel.y(), pattern.Number(row, pattern.Column("v [px]")), 1e-3);
    EXPECT_NEAR((world_from_pattern.Inverse() * world_from_camera.translation).z(),
                pattern.Number(row, pattern.Column("altitude [m]")), 1e-5);
    const double visible = pattern.Number(row, pattern.Column("visible_fraction []"));
    EXPECT_GE(visible, 0);
    EXPECT_LE(visible, 1);
  }
}

TEST(LandingSimulationTest, SameSeedGivesSameBytesWithAnyThreads) {
  const TestFolder folder;
  const auto always = [](std::size_t) { return true; };
  WriteRecording(PlanLanding(SmallFlight(), SmallCamera(), 3), folder / "one", false, 1, always);
  WriteRecording(PlanLanding(SmallFlight(), SmallCamera(), 3), folder / "two", false, 2, always);
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "one")) {
    if (!entry.is_regular_file()) continue;
    const auto name = std::filesystem::relative(entry, folder / "one").string();
    EXPECT_EQ(ReadFile(entry.path().string()), ReadFile(folder / ("two/" + name))) << name;
    ++files;
  }
  EXPECT_EQ(files, 4 + 7);
  const RecordingPlan other = PlanLanding(SmallFlight(), SmallCamera(), 4);
  EXPECT_NE(other.files[2].text, ReadFile(folder / "one/mav0/nav0/data.csv"));
}

TEST(LandingSimulationTest, RecordingIsReadable) {
  const TestFolder folder;
  WriteRecording(PlanLanding(SmallFlight(), SmallCamera(), 3), folder / "flight", false, 1,
                 [](std::size_t) { return true; });
  ImageSequence sequence = OpenEurocRecording(folder / "flight");
  EXPECT_EQ(sequence.frame_count(), 4u);
  EXPECT_GT(sequence.poses().size(), 500u);
  const CameraCalibration camera = ReadCalibration(sequence.calibration_file());
  EXPECT_EQ(camera.intrinsics.fx_px, SmallFisheye().fx_px);
  Frame frame;
  ASSERT_TRUE(sequence.Next(&frame));
  double min = 0;
  double max = 0;
  cv::minMaxLoc(frame.image, &min, &max);
  EXPECT_LT(min, 20);
  EXPECT_GT(max, 120) << "the board is white";
}

TEST(LandingSimulationTest, LookalikesHaveNoPatternRow) {
  LandingSimulationOptions options = SmallFlight();
  options.stills.show = "lookalikes";
  const RecordingPlan plan = PlanLanding(options, SmallCamera(), 3);
  const CsvTable pattern(TextOf(plan, "landing_pattern0/data.csv"), "pattern");
  EXPECT_EQ(pattern.row_count(), 0u);
  EXPECT_EQ(plan.times.size(), 4u);
  EXPECT_FALSE(plan.render(0).empty());
}

TEST(LandingSimulationTest, StillsShowPatternAtTheirPoses) {
  LandingSimulationOptions options = SmallFlight();
  options.stills.show = "pattern";
  options.stills.max_altitude_m = 3;
  const CameraCalibration camera = SmallCamera();
  const RecordingPlan plan = PlanLanding(options, camera, 3);
  const CsvTable pattern(TextOf(plan, "landing_pattern0/data.csv"), "pattern");
  const auto poses = ParsePoseRows(TextOf(plan, "nav0/data.csv"), "nav");
  const CameraModel model(camera.intrinsics);
  ASSERT_EQ(pattern.row_count(), 4u);
  for (std::size_t row = 0; row < 4; ++row) {
    Eigen::Vector2d pixel;
    const RigidTransform camera_in_world = poses[row].world_from_body * *camera.body_from_camera;
    model.Project(camera_in_world.Inverse().translation, &pixel);
    EXPECT_NEAR(pixel.x(), pattern.Number(row, pattern.Column("u [px]")), 1e-2);
    EXPECT_NEAR(pixel.y(), pattern.Number(row, pattern.Column("v [px]")), 1e-2);
  }
}

TEST(LandingSimulationTest, SceneFileDescribesScene) {
  const RecordingPlan plan = PlanLanding(SmallFlight(), SmallCamera(), 7);
  EXPECT_THAT(plan.scene, HasSubstr("time_offset_s: 0."));
  EXPECT_THAT(plan.scene, HasSubstr("true_T_BS:\n"));
  EXPECT_THAT(plan.scene, HasSubstr("seed: 7\n"));
  EXPECT_THAT(plan.scene, HasSubstr("outer_diameter_m: 1"));
  EXPECT_THAT(plan.scene, HasSubstr("sun_elevation_deg: 50"));
}

}  // namespace
}  // namespace kestrel
