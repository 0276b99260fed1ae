// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/labelled_images/landing_stills.h"

#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using ::testing::HasSubstr;

TEST(LandingStillMakerTest, StillsKeepTheirOptions) {
  LandingStillOptions options;
  options.min_altitude_m = 0.35;
  options.max_altitude_m = 1;
  const LandingStillMaker maker(options);
  for (int seed = 0; seed < 6; ++seed) {
    const LandingStill still = maker.MakePattern(seed);
    EXPECT_EQ(still.image.size(), cv::Size(752, 480));
    EXPECT_GE(still.altitude_m, 0.35);
    EXPECT_LE(still.altitude_m, 1);
    EXPECT_GE(still.visible_fraction, 0.2);
    EXPECT_GE(still.ring_minor_px, 6);
    EXPECT_GE(still.ring_major_px, 13);
    const double tilt = std::acos(-still.up_in_camera.z());
    EXPECT_LE(tilt, 40.001 * std::numbers::pi / 180);
    const Vector3d camera_in_pattern = still.camera_from_target.Inverse().translation;
    EXPECT_NEAR(camera_in_pattern.z(), still.altitude_m, 1e-9);
  }
}

// Returns the mean gray value of the still's ink ('ink'), or of the paper between the arms.
double MeanOnPattern(const LandingStill& still, const CameraModel& camera, bool ink) {
  double sum = 0;
  int count = 0;
  const double radius = ink ? 0.45 : 0.25;
  for (double angle = std::numbers::pi / 4; angle < 7; angle += std::numbers::pi / 2) {
    const Vector3d point(radius * std::cos(angle), radius * std::sin(angle), 0);
    Vector2d pixel;
    if (camera.Project(still.camera_from_target * point, &pixel) != ProjectionStatus::kOk) {
      continue;
    }
    sum += still.image.at<std::uint8_t>(std::lround(pixel.y()), std::lround(pixel.x()));
    ++count;
  }
  return sum / count;
}

TEST(LandingStillMakerTest, TruthMatchesPattern) {
  LandingStillOptions options;
  options.min_visible_fraction = 1;
  options.min_ring_minor_px = 30;
  const LandingStillMaker maker(options);
  for (int seed = 0; seed < 8; ++seed) {
    const LandingStill still = maker.MakePattern(seed);
    EXPECT_LT(MeanOnPattern(still, maker.camera(), true) + 8,
              MeanOnPattern(still, maker.camera(), false))
        << "seed " << seed;
  }
}

// A print that is not flat and rigid moves the true centre in the image by as much as the print.
TEST(LandingStillMakerTest, TruthLiesOnSheetAtItsTime) {
  LandingStillOptions flat;
  flat.min_visible_fraction = 1;
  flat.min_ring_minor_px = 40;
  flat.min_altitude_m = 1;
  flat.max_altitude_m = 2;
  LandingStillOptions bulging = flat, folded = flat, rolling = flat;
  bulging.bulge = 0.1;
  folded.fold = 0.05;
  rolling.rolling_skew = 0.05;
  for (const LandingStillOptions& options : {flat, bulging, folded, rolling}) {
    const LandingStillMaker maker(options);
    for (int seed = 0; seed < 5; ++seed) {
      const LandingStill still = maker.MakePattern(seed);
      Vector2d of_flat, of_bulge;
      maker.camera().Project(still.camera_from_target.translation, &of_flat);
      const double height_m = options.bulge * still.pattern.board_size_m;
      maker.camera().Project(still.camera_from_target * Vector3d(0, 0, height_m), &of_bulge);
      if (options.rolling_skew == 0) {
        EXPECT_LT((still.center_px - of_bulge).norm(), 1e-6) << "seed " << seed;
        continue;
      }
      // Proportional to the row; the outer parts of the fisheye change the scale of angles.
      const double rows = std::abs(still.center_px.y() - 239.5);
      const double shift = (still.center_px - of_flat).norm();
      EXPECT_GT(shift, 0.6 * options.rolling_skew * rows) << "seed " << seed;
      EXPECT_LT(shift, 1.7 * options.rolling_skew * rows) << "seed " << seed;
    }
  }
}

TEST(LandingStillMakerTest, SameSeedGivesSameBytes) {
  const LandingStillMaker maker(LandingStillOptions{});
  const LandingStillMaker twin(LandingStillOptions{});
  const cv::Mat pattern = maker.MakePattern(4).image;
  const cv::Mat lookalike = maker.MakeLookalikes(4).image;
  EXPECT_EQ(cv::norm(pattern, twin.MakePattern(4).image, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(lookalike, twin.MakeLookalikes(4).image, cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(pattern, twin.MakePattern(5).image, cv::NORM_INF), 0);
}

TEST(LandingStillMakerTest, LookalikesHaveNames) {
  const LandingStillMaker maker(LandingStillOptions{});
  for (int seed = 0; seed < 4; ++seed) {
    const LookalikeStill still = maker.MakeLookalikes(seed);
    EXPECT_FALSE(still.names.empty());
    EXPECT_LE(still.names.size(), 5u);
    EXPECT_EQ(still.image.type(), CV_8UC1);
  }
}

std::string ErrorOf(const LandingStillOptions& options) {
  try {
    LandingStillMaker(options).MakePattern(1);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(LandingStillMakerTest, RefusesInvalidOptions) {
  LandingStillOptions options;
  options.max_altitude_m = 1;
  options.max_tilt_deg = 85;
  options.pattern.ring_width_m = 0.6;
  EXPECT_THAT(ErrorOf(options), HasSubstr("max_altitude_m is 1, expected 2 or more"));
  EXPECT_THAT(ErrorOf(options), HasSubstr("max_tilt_deg is 85, expected 0 to 80"));
  EXPECT_THAT(ErrorOf(options), HasSubstr("pattern.ring_width_m is 0.6"));

  LandingStillOptions too_high;
  too_high.min_altitude_m = too_high.max_altitude_m = 100;
  EXPECT_THAT(ErrorOf(too_high), HasSubstr("no pose at an altitude of 100.00 m"));
}

constexpr int kStills = 6;  // stills per condition

struct MeanLevels {
  double ink = 0, white = 0;
  int shadows = 0;  // number of stills that have one
};

// Returns mean gray values of stills of a condition.
MeanLevels LevelsUnder(StillCondition condition) {
  LandingStillOptions options;
  options.condition = condition;
  options.min_visible_fraction = 1;
  const LandingStillMaker maker(options);
  MeanLevels levels;
  for (int seed = 0; seed < kStills; ++seed) {
    const LandingStill still = maker.MakePattern(seed);
    levels.ink += MeanOnPattern(still, maker.camera(), true) / kStills;
    levels.white += MeanOnPattern(still, maker.camera(), false) / kStills;
    levels.shadows += still.has_shadow;
  }
  return levels;
}

TEST(LandingStillMakerTest, ConditionsChangeImage) {
  const MeanLevels mixed = LevelsUnder(StillCondition::kMixed);
  const MeanLevels dark = LevelsUnder(StillCondition::kDark);
  EXPECT_LT(dark.white - dark.ink, 0.5 * (mixed.white - mixed.ink));
  const MeanLevels night = LevelsUnder(StillCondition::kNight);
  EXPECT_LT(night.white, 45);
  EXPECT_GT(night.white - night.ink, 8);
  EXPECT_GT(LevelsUnder(StillCondition::kDust).ink, mixed.ink + 20);
  EXPECT_GT(LevelsUnder(StillCondition::kGlare).ink, mixed.ink + 20);
  EXPECT_EQ(LevelsUnder(StillCondition::kUavShadow).shadows, kStills);
  EXPECT_LT(mixed.shadows, kStills);
}

}  // namespace
}  // namespace kestrel
