// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/print/print_measurement.h"

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kestrel/calibration/print/print_check.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/labelled_images/scene_renderer.h"
#include "kestrel/simulation/scene/landing_drawings.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

// The lens of a telephone, with a little barrel distortion.
CameraIntrinsics Telephone() {
  return {1344, 1008, 967, 967, 680, 499, DistortionModel::kRadialTangential, {-0.02, 0, 0, 0}};
}

// A photograph of a print on its board, in uneven light.
cv::Mat Photograph(const LandingPattern& print, double distance_m, double tilt_deg) {
  Scene scene;
  scene.layers.push_back({SquareBoard({0, 0}, print.board_size_m, kPi / 4), 0.85});
  scene.layers.push_back({LandingPatternInk(print), 0.08});
  ImagingOptions imaging;
  imaging.blur_sigma_px = 0.8;
  imaging.read_noise = 1.5;
  imaging.shot_noise = 1.5;
  imaging.gradient = {0.2, -0.1};
  const Eigen::Quaterniond facing(AngleAxisd(kPi, Vector3d::UnitX()));
  const RigidTransform pose{AngleAxisd(Radians(tilt_deg), Vector3d(0.6, 0.8, 0)) * facing *
                                AngleAxisd(0.4, Vector3d::UnitZ()),
                            {0.05, -0.03, distance_m}};
  return SceneRenderer(CameraModel(Telephone())).Render(scene, pose, imaging);
}

LandingPatternDetectorOptions Configured() { return {}; }

void ExpectMeasured(const MeasuredLength& length, double truth, double largest_m,
                    const std::string& what) {
  EXPECT_NEAR(length.value_m, truth, 3 * length.sigma_m) << what;
  EXPECT_NEAR(length.value_m, truth, largest_m) << what;
}

TEST(PrintMeasurementTest, MeasuresPrintsOfOtherDimensions) {
  const LandingPattern configured = Configured().pattern;
  LandingPattern thin_ring, wide_arms, short_arms, other;
  thin_ring.ring_width_m = 0.08;
  wide_arms.arm_width_m = 0.115;
  short_arms.arm_half_length_m = 0.33;
  other.ring_width_m = 0.12;
  other.arm_width_m = 0.08;
  other.arm_half_length_m = 0.36;
  double tilt_deg = 3;
  for (const LandingPattern& print : {configured, thin_ring, wide_arms, short_arms, other}) {
    tilt_deg += 7;
    const double distance_m = 1.5;
    const cv::Mat photo = Photograph(print, distance_m, tilt_deg);
    for (const bool is_calibrated : {true, false}) {
      const std::string what =
          fmt::format("ring {} arms {} {} tilt {} calibrated {}", print.ring_width_m,
                      print.arm_width_m, print.arm_half_length_m, tilt_deg, is_calibrated);
      const auto seen = MeasurePrint(
          photo, is_calibrated ? std::optional(Telephone()) : std::nullopt, Configured());
      ASSERT_TRUE(seen) << what;
      const double largest_m = (is_calibrated ? 0.5 : 1.5) * seen->pixel_m;
      ExpectMeasured(seen->ring_width, print.ring_width_m, largest_m, what);
      ExpectMeasured(seen->arm_width, print.arm_width_m, largest_m, what);
      ASSERT_TRUE(seen->arm_half_length) << what;
      ExpectMeasured(*seen->arm_half_length, print.arm_half_length_m, largest_m, what);
      EXPECT_NEAR(seen->pixel_m, distance_m / 967, 0.1e-3) << what;
      if (!is_calibrated) continue;
      EXPECT_NEAR(seen->distance.value_m, distance_m, 3 * seen->distance.sigma_m) << what;
    }
  }
}

// Such a photograph does not determine the focal length.
TEST(PrintMeasurementTest, MeasuresPrintSeenFromStraightAbove) {
  const LandingPattern print = Configured().pattern;
  for (const double distance_m : {1.2, 2.0, 3.0}) {
    for (const double tilt_deg : {0.0, 0.5, 1.5}) {
      const auto seen = MeasurePrint(Photograph(print, distance_m, tilt_deg), {}, Configured());
      const std::string what = fmt::format("{} m, {} degrees", distance_m, tilt_deg);
      ASSERT_TRUE(seen) << what;
      ExpectMeasured(seen->ring_width, print.ring_width_m, 3 * seen->pixel_m, what);
      ExpectMeasured(seen->arm_width, print.arm_width_m, 3 * seen->pixel_m, what);
    }
  }
}

TEST(PrintMeasurementTest, FindsNoPrintInEmptyImage) {
  EXPECT_FALSE(MeasurePrint(cv::Mat(480, 640, CV_8UC1, cv::Scalar(120)), {}, Configured()));
  const cv::Mat far = Photograph({}, 60, 10);
  EXPECT_FALSE(MeasurePrint(far, Telephone(), Configured()));
}

TEST(PrintCheckTest, JudgesByUncertaintyOfPhotograph) {
  const LandingPattern configured;
  PrintMeasurement print{.ring_width = {0.1003, 0.0005},
                         .arm_width = {0.095, 0.0005},
                         .arm_half_length = MeasuredLength{0.37, 0.02},
                         .distance = {2, 0.004},
                         .pixel_m = 0.001,
                         .ring_px = 1000};
  const auto checked = CheckPrint(configured, print, {});
  ASSERT_EQ(checked.size(), 3u);
  EXPECT_EQ(checked[0].verdict, PrintVerdict::kGood);
  EXPECT_EQ(checked[1].verdict, PrintVerdict::kWrong);
  EXPECT_EQ(checked[1].option, "arm_width_m");
  EXPECT_EQ(checked[2].verdict, PrintVerdict::kTooCoarse);
}

TEST(PrintCheckTest, JudgesArmsWithoutVisibleEnds) {
  PrintMeasurement print{.ring_width = {0.1, 0.0005},
                         .arm_width = {0.1, 0.0005},
                         .arm_half_length = {},
                         .distance = {2, 0.004},
                         .pixel_m = 0.001,
                         .ring_px = 1000};
  const auto arms = [&print](double half_length, double pixel_m) {
    print.pixel_m = pixel_m;
    return CheckPrint({.arm_half_length_m = half_length}, print, {}).back().verdict;
  };
  EXPECT_EQ(arms(0.4, 0.001), PrintVerdict::kGood) << "they reach the ring, as they should";
  EXPECT_EQ(arms(0.38, 0.001), PrintVerdict::kWrong) << "a gap of 20 px would be seen";
  EXPECT_EQ(arms(0.38, 0.005), PrintVerdict::kTooCoarse) << "one of 4 px would not";
}

TEST(PrintCheckTest, DetectsScaledDownPrint) {
  const PrintMeasurement print{.ring_width = {0.1, 0.0005},
                               .arm_width = {0.1, 0.0005},
                               .arm_half_length = MeasuredLength{0.38, 0.0005},
                               .distance = {2, 0.004},
                               .pixel_m = 0.001,
                               .ring_px = 1000};
  for (const PrintScale& scale : {ScaleByRuler(0.194, {}), ScaleByDistance(1.94, print)}) {
    const auto checked = CheckPrint({}, print, scale);
    ASSERT_EQ(checked.size(), 4u);
    EXPECT_EQ(checked[0].option, "outer_diameter_m");
    EXPECT_NEAR(checked[0].measured->value_m, 0.97, 1e-9);
    EXPECT_EQ(checked[0].verdict, PrintVerdict::kWrong);
  }
  EXPECT_EQ(CheckPrint({}, print, ScaleByRuler(0.1998, {}))[0].verdict, PrintVerdict::kGood);
  EXPECT_EQ(CheckPrint({}, print, ScaleByDistance(2.015, print))[0].verdict, PrintVerdict::kGood);
}

}  // namespace
}  // namespace kestrel
