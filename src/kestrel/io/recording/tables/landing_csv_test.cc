// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/tables/landing_csv.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

LandingObservation Found() {
  TargetDetection detection{};
  detection.center_px = {320.25, 239.5};
  detection.camera_from_target.translation = {0.1, -0.2, 3};
  detection.covariance.setZero();
  detection.covariance.diagonal().head<3>() = Eigen::Vector3d(0.0001, 0.0004, 0.0009);
  detection.method = DetectionMethod::kRing;
  detection.quality = 0.875;
  detection.diagnostics.misfit_px = 0.125;
  LandingObservation observation;
  observation.time = TimeFromNanoseconds(1234567890123456789);
  observation.report.detection = detection;
  observation.report.reached = LandingStage::kFound;
  observation.detect_time = std::chrono::microseconds(1250);
  return observation;
}

auto Commas(const std::string& line) { return std::count(line.begin(), line.end(), ','); }

TEST(LandingCsv, WritesDetectionWithoutPose) {
  EXPECT_EQ(LandingCsvRow("a/b.png", Found()),
            "a/b.png,1234567890123456789,1,320.250,239.500,ring,0.8750,0.100000,-0.200000,3.000000"
            ",,,,,0.010000,0.020000,0.030000,,1.2500,0.125,\n");
}

TEST(LandingCsv, WritesDetectionInWorld) {
  LandingObservation observation = Found();
  observation.center_in_world = Eigen::Vector3d(10, 20, 0.5);
  observation.yaw_in_world = -0.25;
  EXPECT_EQ(LandingCsvRow("b", observation),
            "b,1234567890123456789,1,320.250,239.500,ring,0.8750,0.100000,-0.200000,3.000000,"
            "10.000000,20.000000,0.500000,-0.250000,0.010000,0.020000,0.030000,,1.2500,0.125,\n");
}

TEST(LandingCsv, LeavesMisfitEmptyWithoutEdges) {
  LandingObservation observation = Found();
  observation.report.detection->diagnostics.misfit_px = 0;
  EXPECT_TRUE(LandingCsvRow("b", observation).ends_with(",1.2500,,\n"));
}

TEST(LandingCsv, WritesMethodAndIdOfPad) {
  LandingObservation observation = Found();
  observation.report.detection->method = DetectionMethod::kTags;
  observation.report.detection->id = 17;
  const std::string row = LandingCsvRow("b", observation);
  EXPECT_TRUE(row.ends_with(",0.125,17\n")) << row;
  EXPECT_NE(row.find(",tags,"), std::string::npos) << row;
}

TEST(LandingCsv, WritesStageOfMiss) {
  LandingObservation observation;
  observation.time = TimeFromNanoseconds(5);
  observation.report.reached = LandingStage::kCross;
  EXPECT_EQ(LandingCsvRow("b", observation), "b,5,0,,,,,,,,,,,,,,,cross,0.0000,,\n");
}

TEST(LandingCsv, EveryRowIsAsWideAsHeader) {
  EXPECT_EQ(Commas(LandingCsvHeader()), 20);
  EXPECT_EQ(Commas(LandingCsvRow("b", Found())), 20);
  EXPECT_EQ(Commas(LandingCsvRow("b", LandingObservation())), 20);
}

TEST(LandingCsv, QuotesNameWithComma) {
  EXPECT_TRUE(LandingCsvRow("a,\"b\".png", Found()).starts_with("\"a,\"\"b\"\".png\",1234"));
}

}  // namespace
}  // namespace kestrel
