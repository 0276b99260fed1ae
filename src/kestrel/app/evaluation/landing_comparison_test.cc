// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/landing_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/evaluation/landing_tables.h"
#include "kestrel/app/evaluation/test_flight.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// The pattern on the ground, straight below the camera of TestFlight.
TruePattern PatternBelow(int frame, double visible_fraction = 1) {
  return {FrameTime(frame), {}, Eigen::Vector3d::Zero(), {320, 240}, 4, visible_fraction};
}

DetectionRow Detected(int frame, const Eigen::Vector2d& center_px = {320, 240}) {
  DetectionRow::Pattern pattern;
  pattern.center_px = center_px;
  pattern.center_in_camera = {0, 0, 4};
  pattern.sigma_in_camera = {0.01, 0.02, 0.05};
  return {FrameTime(frame), pattern};
}

DetectionRow Missed(int frame) { return {FrameTime(frame), {}}; }

std::vector<LandingVerdict> Verdicts(const std::vector<LandingComparison>& comparisons) {
  std::vector<LandingVerdict> verdicts;
  for (const LandingComparison& c : comparisons) verdicts.push_back(c.verdict);
  return verdicts;
}

TEST(IsRightCenter, AllowsFourPixelsOrPartOfRing) {
  EXPECT_TRUE(IsRightCenter({3.9, 0}, {0, 0}, 0));
  EXPECT_FALSE(IsRightCenter({4.1, 0}, {0, 0}, 10));
  EXPECT_TRUE(IsRightCenter({14, 0}, {0, 0}, 100));
}

TEST(MeasureErrors, SplitsAlongAndAcrossLineOfSight) {
  DetectionRow::Pattern detected = *Detected(0).pattern;
  detected.center_px = {323, 244};
  detected.center_in_camera = {0.03, -0.04, 4.1};
  detected.center_in_world = Eigen::Vector3d(1, 2, 2);
  detected.yaw_in_world = -kPi / 4 + 0.01;  // the pattern looks the same after a quarter turn
  TruePattern truth = PatternBelow(0);
  truth.world_from_pattern.rotation = Eigen::AngleAxisd(kPi / 4 - 0.02, Eigen::Vector3d::UnitZ());
  const TestFlight files;
  const auto world_from_camera = FlightTruth(files.recording()).WorldFromCamera(FrameTime(0));
  const LandingErrors errors = MeasureErrors(detected, truth, *world_from_camera, 4);
  EXPECT_NEAR(errors.center_px, 5, 1e-9);
  EXPECT_NEAR(errors.lateral_m, 0.05, 1e-9);
  EXPECT_NEAR(errors.depth_m, 0.1, 1e-9);
  EXPECT_NEAR(errors.nees, 9 + 4 + 4, 1e-9);
  EXPECT_NEAR(errors.in_world->norm(), 3, 1e-9);
  EXPECT_NEAR(*errors.yaw, 0.03, 1e-9);
}

// Returns the error of the yaw when the estimate is so many quarter turns off, and 0.02 rad.
std::optional<double> YawErrorAfter(int quarters, std::optional<int> symmetry, bool has_id) {
  DetectionRow::Pattern detected = *Detected(0).pattern;
  detected.yaw_in_world = quarters * kPi / 2 + 0.02;
  detected.has_id = has_id;
  return MeasureErrors(detected, PatternBelow(0), RigidTransform(), symmetry).yaw;
}

TEST(MeasureErrors, ComparesYawUpToSymmetryOfPad) {
  EXPECT_NEAR(*YawErrorAfter(1, 4, false), 0.02, 1e-9) << "ring";
  EXPECT_NEAR(*YawErrorAfter(2, 2, false), 0.02, 1e-9) << "H";
  EXPECT_NEAR(*YawErrorAfter(1, 2, false), -kPi / 2 + 0.02, 1e-9) << "H, a quarter turn off";
  EXPECT_NEAR(*YawErrorAfter(1, 1, true), kPi / 2 + 0.02, 1e-9) << "tags";
  EXPECT_NEAR(*YawErrorAfter(1, 1, false), 0.02, 1e-9) << "ring of a pad whose tags were not read";
  EXPECT_FALSE(YawErrorAfter(0, std::nullopt, true)) << "unknown pad";
}

TEST(CompareLanding, ReadsKindOfPadFromScene) {
  const TestFlight files;
  files.WriteTruth("scene.yaml", "options: {target: {kind: apriltag}}\n");
  DetectionRow row = Detected(0);
  row.pattern->yaw_in_world = kPi;
  row.pattern->has_id = true;
  const auto comparisons =
      CompareLanding(FlightTruth(files.recording()), {PatternBelow(0)}, {row}, "file");
  ASSERT_TRUE(comparisons[0].errors);
  EXPECT_NEAR(std::abs(*comparisons[0].errors->yaw), kPi, 1e-9);
}

TEST(CompareLanding, JudgesEveryFrame) {
  const TestFlight files;
  const FlightTruth flight(files.recording());
  const auto comparisons = CompareLanding(
      flight, {PatternBelow(0), PatternBelow(1), PatternBelow(2)},
      {Detected(0), Detected(1, {500, 240}), Missed(2), Missed(3), Detected(4)}, "file");
  EXPECT_THAT(Verdicts(comparisons),
              ElementsAre(LandingVerdict::kFound, LandingVerdict::kFalse, LandingVerdict::kMissed,
                          LandingVerdict::kQuiet, LandingVerdict::kFalse));
  EXPECT_TRUE(comparisons[0].errors);
  EXPECT_FALSE(comparisons[1].errors);
}

TEST(CompareLanding, RefusesRowWithoutImage) {
  const TestFlight files;
  const FlightTruth flight(files.recording());
  const DetectionRow row = {TimeFromNanoseconds(7), {}};
  EXPECT_THAT(InputErrorOf([&] { CompareLanding(flight, {}, {row}, "landing.csv"); }),
              HasSubstr("landing.csv: timestamp 7 is not that of an image"));
}

TEST(CompareLanding, UsesMotionDuringExposure) {
  const TestFlight files(5);
  files.WriteTruth("scene.yaml", "options: {shutter: {exposure_s: 0.02}}\n");
  const FlightTruth flight(files.recording());
  TruePattern pattern = PatternBelow(2);
  pattern.velocity_in_world = {5, 0, 0};  // 10 cm at 4 m
  const auto comparisons = CompareLanding(flight, {pattern}, {Detected(2)}, "file");
  ASSERT_TRUE(comparisons[0].motion_px);
  EXPECT_NEAR(*comparisons[0].motion_px, 10, 1e-6);
  EXPECT_NEAR(*comparisons[0].tilt, 0, 1e-9);
}

TEST(SuccessTable, CountsVisiblePatternsOnly) {
  const TestFlight files;
  const FlightTruth flight(files.recording());
  const auto comparisons =
      CompareLanding(flight, {PatternBelow(0), PatternBelow(1), PatternBelow(2, 0.2)},
                     {Detected(0), Missed(1), Missed(2), Detected(3)}, "file");
  const ReportTable table = SuccessTable(comparisons);
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_THAT(table.rows[0], ElementsAre("all", "2 to 6", "2", "1", "50.0", "9.5 to 90.5", "0"));
  EXPECT_THAT(table.rows[2], ElementsAre("all", "not in view", "2", "-", "-", "-", "1"));
}

TEST(ErrorTable, HasRowForEveryAltitudeWithDetection) {
  const TestFlight files;
  const FlightTruth flight(files.recording());
  const auto comparisons =
      CompareLanding(flight, {PatternBelow(0)}, {Detected(0, {321, 240})}, "file");
  const ReportTable errors = ErrorTable(comparisons);
  ASSERT_EQ(errors.rows.size(), 2u);  // and the row for all
  EXPECT_EQ(errors.rows[0][0], "2 to 6");
  EXPECT_EQ(errors.rows[0][2], "1.00");
  EXPECT_EQ(errors.rows[0][8], "-");  // no position in the world
  EXPECT_EQ(errors.rows[0].size(), errors.columns.size());
  EXPECT_EQ(ConsistencyTable(comparisons).rows.size(), 2u);
}

TEST(VisibleFractionTable, SeparatesWholePattern) {
  const TestFlight files;
  const FlightTruth flight(files.recording());
  const auto comparisons = CompareLanding(flight, {PatternBelow(0), PatternBelow(1, 0.8)},
                                          {Detected(0), Missed(1)}, "file");
  const ReportTable table = VisibleFractionTable(comparisons);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_THAT(table.rows[0], ElementsAre("0.75 to 1", "1", "0", "0.0", "0.0 to 79.3", "0"));
  EXPECT_THAT(table.rows[1], ElementsAre("1", "1", "1", "100.0", "20.7 to 100.0", "0"));
}

}  // namespace
}  // namespace kestrel
