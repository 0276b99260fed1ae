// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/touchdown_simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/io/recording/test_files.h"
#include "kestrel/simulation/recordings/landing_simulation.h"
#include "kestrel/simulation/recordings/scenarios.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

// Options that render fast.
TouchdownSimulationOptions Small() {
  return ReadTouchdownSimulation("figure8", "",
                                 {"shutter.rays_per_pixel=1", "ground.map_px=512", "rate_hz=15"});
}

const TouchdownSimulation::FrameSink kAll = [](const auto&...) { return true; };

TEST(TouchdownSimulationTest, LandsOnMovingVehicle) {
  TouchdownSimulation simulation(Small(), PaperCalibration(), 3);
  int images = 0;
  const auto result = simulation.Fly(
      [&](const cv::Mat& image, const LandingObservation& observation, const LandingPipeline&) {
        EXPECT_EQ(image.size(), cv::Size(752, 480));
        EXPECT_EQ(observation.pose, PoseLookup::kFound);
        ++images;
        return true;
      });
  ASSERT_TRUE(result);
  EXPECT_EQ(result->outcome, TouchdownOutcome::kLanded) << InWords(*result);
  EXPECT_LT(result->time_s, 30);
  EXPECT_LT(result->distance_m, 0.4);
  EXPECT_LT(result->slip_mps, 1);
  EXPECT_EQ(result->frames, images);
  EXPECT_EQ(result->path.size(), static_cast<std::size_t>(images));
  EXPECT_GE(result->wind_mps, 2);
  const auto& start = result->path.front();
  EXPECT_NEAR(start.feet_in_world.z(), 10 - 0.35, 1e-6);
}

TEST(TouchdownSimulationTest, RefusesGimbal) {
  TouchdownSimulationOptions options = Small();
  options.recording.gimbal.rate_hz = 20;
  EXPECT_THAT([&] { TouchdownSimulation(options, PaperCalibration(), 3); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("gimbal.rate_hz")));
}

TEST(TouchdownSimulationTest, SameSeedGivesSameFlight) {
  TouchdownSimulationOptions options = Small();
  options.recording.frames = 12;
  std::string rows[2];
  for (std::string& row : rows) {
    TouchdownSimulation simulation(options, PaperCalibration(), 5);
    const auto result = simulation.Fly(kAll);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->outcome, TouchdownOutcome::kTimeUp);
    EXPECT_EQ(result->frames, 12);
    row = TouchdownCsvRow(5, *result) + TouchdownPathCsv(*result);
  }
  EXPECT_EQ(rows[0], rows[1]);
}

TEST(TouchdownSimulationTest, StopsWhenCallbackReturnsFalse) {
  TouchdownSimulation simulation(Small(), PaperCalibration(), 5);
  EXPECT_FALSE(simulation.Fly([](const auto&...) { return false; }));
}

TEST(TouchdownSimulationTest, ReportsFaultyOptions) {
  TouchdownSimulationOptions options = Small();
  options.wind.max_mps = -1;
  options.touchdown.leg_m = 0;
  options.vehicle.speed_mps = 99;
  const std::string error =
      InputErrorOf([&] { TouchdownSimulation(options, PaperCalibration(), 1); });
  EXPECT_THAT(error, HasSubstr("wind.max_mps is -1"));
  EXPECT_THAT(error, HasSubstr("touchdown.leg_m is 0, expected 0.05 to 2"));
  EXPECT_THAT(error, HasSubstr("vehicle.speed_mps is 99"));
}

TEST(TouchdownResultTest, ReportsEndAsTextAndRow) {
  TouchdownResult result;
  result.time_s = 90;
  EXPECT_THAT(InWords(result), HasSubstr("still in the air after 90.0 s; pattern never seen"));
  EXPECT_EQ(TouchdownCsvRow(7, result), "7,time up,90.000,,,,,0,0.00,0,\n");
  result.outcome = TouchdownOutcome::kLanded;
  result.first_seen_s = 2.5;
  result.distance_m = 0.123;
  EXPECT_THAT(InWords(result),
              HasSubstr("landed 90.0 s after the start, 0.12 m from the centre (true)"));
  EXPECT_EQ(TouchdownCsvRow(7, result), "7,landed,90.000,2.500,0.1230,0.000,0.000,0,0.00,0,\n");
  result.heading_error = Radians(-1.5);
  EXPECT_THAT(InWords(result), HasSubstr(", heading off by -1.5 degrees; pattern first"));
  EXPECT_THAT(TouchdownCsvRow(7, result), HasSubstr(",0.00,0,-1.50\n"));
}

}  // namespace
}  // namespace kestrel
