// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/calibration/calibration_report.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/calibration/lens/test_lens_views.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

TEST(CalibrationRequestTest, NamesWhatIsSaved) {
  const auto name = [](const std::vector<std::string>& words) {
    return ParseCalibrationRequest(words).Name();
  };
  EXPECT_EQ(name({"lens"}), "lens");
  EXPECT_EQ(name({"mount"}), "mount");
  EXPECT_EQ(name({"moving", "clock"}), "clock");
  EXPECT_EQ(name({"mount", "clock"}), "mount_clock");
}

TEST(CalibrationRequestTest, RefusesOtherWords) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{},
                                             {"moving"},
                                             {"lens", "mount"},
                                             {"lens", "moving"},
                                             {"mount", "mount"},
                                             {"Mount"},
                                             {"../mount"},
                                             {""}}) {
    EXPECT_THROW(ParseCalibrationRequest(words), InputError);
  }
}

TEST(CalibrationReportTest, DescribesCoverageOfFlight) {
  const std::vector<PatternPlace> places = {{{1, 1}, 2.5}, {{2, 2}, 1.25}, {{799, 599}, 9}};
  const ConsoleCalibration report = FlightCoverage(places, 40, {800, 600});
  EXPECT_EQ(report.coverage,
            "the pattern was found in 3 of 40 images, its centre in 2 of 48 fields of the image, "
            "from 1.2 to 9.0 m above it");
  EXPECT_EQ(report.places.size(), 3u);
  EXPECT_EQ(FlightCoverage({}, 40, {800, 600}).coverage, "the pattern was found in 0 of 40 images");
  // The message of a long flight stays small enough for a slow browser.
  EXPECT_LE(FlightCoverage(std::vector<PatternPlace>(9001), 9001, {8, 6}).places.size(), 2000u);
}

TEST(CalibrationReportTest, HasNumbersOfFlightWithUncertainty) {
  FlightCalibration result;
  result.angles = {0.01, 0, -0.02};
  result.angle_sigmas = {0.001, 0.001, 0.002};
  result.estimate.clock_offset_s = 0.05;
  result.clock_sigma_s = 0.001;
  result.sightings = 2;
  result.rms_before_m = 0.5;
  result.rms_after_m = 0.1;
  const Time begin(std::chrono::seconds(1000));
  result.residuals = {{begin, 0.6, 0.1}, {begin + std::chrono::milliseconds(1500), 0.4, 0.1}};
  ConsoleCalibration report;
  AddFlight(result, {}, {{}, 0.02}, &report);
  ASSERT_EQ(report.numbers.size(), 4u);
  EXPECT_NEAR(report.numbers[0].after, 0.573, 0.001);
  EXPECT_EQ(report.numbers[3].before, 0.02);
  EXPECT_EQ(report.numbers[3].after, 0.05);
  EXPECT_EQ(report.numbers[3].sigma, 0.001);
  EXPECT_EQ(report.residuals.points[1], (std::array<double, 3>{1.5, 0.4, 0.1}));
  ConsoleCalibration clock_only;
  AddFlight(result, {.estimate_mount = false}, {}, &clock_only);
  EXPECT_EQ(clock_only.numbers.size(), 1u);
}

TEST(CalibrationReportTest, OmitsWhatFlightCannotDetermine) {
  const auto no_use = [](double angle_sigma, double clock_sigma_s, double rms_after_m) {
    FlightCalibration result;
    result.angle_sigmas.setConstant(angle_sigma);
    result.clock_sigma_s = clock_sigma_s;
    result.rms_before_m = 0.5;
    result.rms_after_m = rms_after_m;
    ConsoleCalibration report;
    AddFlight(result, {}, {}, &report);
    return report.no_use;
  };
  EXPECT_EQ(no_use(0.01, 0.01, 0.5), "");
  EXPECT_THAT(no_use(0.4, 0.01, 0.4),
              HasSubstr("does not determine the mount's roll (+- 22.9 degrees), pitch"));
  EXPECT_THAT(no_use(0.01, 0.2, 0.4), HasSubstr("does not determine the clock offset (+- 0.2 s)"));
  EXPECT_THAT(no_use(0.01, 0.01, 0.6), HasSubstr("agree less"));
}

TEST(CalibrationReportTest, ComparesLensWithGivenOneOnSameViews) {
  const CameraIntrinsics truth{640, 480, 400, 400, 325, 236, DistortionModel::kNone, {}};
  CameraIntrinsics given = truth;
  given.fx_px = given.fy_px = 440;
  const LensCalibration lens = EstimateLens(MakeLensViews(truth, {}), given);
  const ConsoleCalibration report = LensReport(lens, given, 60);
  EXPECT_EQ(report.numbers[0].before, 440);
  EXPECT_NEAR(report.numbers[0].after, 400, 1);
  EXPECT_GT(report.numbers[0].sigma, 0);
  EXPECT_LT(report.residuals.rms_after, 0.2);
  EXPECT_GT(report.residuals.rms_before, 2 * report.residuals.rms_after);
  EXPECT_EQ(report.distances_m.size(), lens.views.size());
  EXPECT_THAT(report.coverage, HasSubstr(" of 60 images, "));
  EXPECT_THAT(report.coverage, HasSubstr(lens.coverage.InWords()));
  // A lens of eight coefficients is not compared.
  given.distortion_model = DistortionModel::kRadialTangential;
  given.distortion.resize(8);
  EXPECT_TRUE(std::isnan(LensReport(lens, given, 60).residuals.rms_before));
}

}  // namespace
}  // namespace kestrel
