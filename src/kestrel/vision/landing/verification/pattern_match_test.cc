// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/verification/pattern_match.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

// Least share of a part of the print that counts as in place.
constexpr double kInPlace = 0.65;

// True when all parts of a match speak for the print.
bool AgreesInAll(const PatternMatch& match) {
  return match.Agreement() > kInPlace && match.shares.MeansInView().worst_arm > kInPlace;
}

class PatternMatcherTest : public ::testing::Test {
 protected:
  PatternMatch Match(const cv::Mat& image, const RigidTransform& pose) const {
    return matcher_.Match(image, PatternView(camera_, pose, matcher_.extent_m(), {}));
  }
  cv::Mat Draw(const Print& print) const { return DrawPrint(camera_, pattern_, print, pose_); }

  const LandingPattern pattern_{};
  const CameraModel camera_ = TestPrintCamera();
  const PatternMatcher matcher_{pattern_};
  const RigidTransform pose_ = PrintPose({0.1, -0.05, 2.5}, 0.4, 1, 0.3);
  const cv::Mat pattern_image_ = DrawPrint(camera_, pattern_, SpokedPrint(pattern_, 4), pose_);
};

TEST_F(PatternMatcherTest, ThePatternAgreesEverywhere) {
  const PatternMatch match = Match(pattern_image_, pose_);
  for (int k = 0; k < 4; ++k) {
    EXPECT_GT(match.shares.arm[k], 0.9);
    EXPECT_GT(match.shares.quadrant[k], 0.95);
    EXPECT_GT(match.shares.ring[k], 0.95);
  }
  EXPECT_EQ(match.seen, 1);
  EXPECT_NEAR(match.contrast, 160, 25);
  EXPECT_GT(match.Agreement(), 0.9);
}

TEST_F(PatternMatcherTest, TheDirectionOfTheArmsMatters) {
  const RigidTransform turned = PrintPose({0.1, -0.05, 2.5}, 0.4, 1, 0.3 + 0.785);
  EXPECT_LT(Match(pattern_image_, turned).Agreement(), 0.3);
}

TEST_F(PatternMatcherTest, OtherFiguresInTheRingDoNotAgree) {
  for (const int spokes : {1, 2, 3, 5, 6, 8}) {
    EXPECT_FALSE(AgreesInAll(Match(Draw(SpokedPrint(pattern_, spokes)), pose_))) << spokes;
  }
  const Print empty = [this](double x, double y) { return IsRing(pattern_, x, y); };
  EXPECT_FALSE(AgreesInAll(Match(Draw(empty), pose_)));
  const Print full = [this](double x, double y) {
    return std::hypot(x, y) < pattern_.outer_radius_m();
  };
  EXPECT_FALSE(AgreesInAll(Match(Draw(full), pose_)));
}

TEST_F(PatternMatcherTest, AMissingArmIsSeen) {
  const Print three = [this](double x, double y) {
    return SpokedPrint(pattern_, 4)(x, y) && !(x > 0.06 && std::abs(y) < 0.06 && x < 0.39);
  };
  const PatternMatch match = Match(Draw(three), pose_);
  EXPECT_LT(match.shares.arm[0], 0.2);
  EXPECT_GT(match.shares.arm[1], 0.9);
  EXPECT_FALSE(AgreesInAll(match));
}

// A sign with one bar, whose inside is nearer to black than to the white around it: something that
// hides an arm must be darker than the inside.
TEST_F(PatternMatcherTest, AGrayInsideHidesNoArm) {
  const Print disc = [this](double x, double y) {
    return std::hypot(x, y) < pattern_.inner_radius_m();
  };
  cv::Mat image = Draw(SpokedPrint(pattern_, 2));
  const cv::Mat inside = Draw(disc);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      auto& gray = image.at<std::uint8_t>(v, u);
      if (inside.at<std::uint8_t>(v, u) == 40) gray = static_cast<std::uint8_t>(24 + 0.4 * gray);
    }
  }
  const PatternMatch match = Match(image, pose_);
  EXPECT_GT(match.shares.arm[0], 0.9);
  EXPECT_GE(match.shares.arm[1], 0) << "seen";
  EXPECT_LT(match.shares.arm[1], 0.2);
  EXPECT_FALSE(AgreesInAll(match));
}

TEST_F(PatternMatcherTest, AnArmBehindALandingLegIsNotMissing) {
  const Print pattern = SpokedPrint(pattern_, 4);
  const Print behind_leg = [&](double x, double y) {
    return pattern(x, y) || (x > 0.1 && std::abs(y) < 0.13);
  };
  const PatternMatch match = Match(Draw(behind_leg), pose_);
  EXPECT_LT(match.shares.arm[0], 0) << "not seen";
  EXPECT_GT(match.shares.arm[1], 0.9);
  EXPECT_TRUE(AgreesInAll(match));
}

// A highlight is brighter than any white of the print. A missing arm is only as bright as white.
TEST_F(PatternMatcherTest, AnArmInAHighlightIsNotMissing) {
  const Print spot = [](double x, double y) { return std::hypot(x - 0.22, y) < 0.18; };
  const cv::Mat in_spot = Draw(spot) == 40;
  cv::Mat image = pattern_image_.clone();
  image.setTo(255, in_spot);
  const PatternMatch match = Match(image, pose_);
  EXPECT_LT(match.shares.arm[0], 0) << "not seen";
  EXPECT_GT(match.shares.arm[1], 0.9);
  EXPECT_TRUE(AgreesInAll(match));
  image.setTo(200, in_spot);
  EXPECT_FALSE(AgreesInAll(Match(image, pose_))) << "as white as the board";
}

TEST_F(PatternMatcherTest, AnArmAlongTheImageBorderIsSeenByItsInnerSide) {
  // The centre is 5 px from the border, so only one side of the arms along it is in view.
  const RigidTransform pose = PrintPose({-154.5 / 220, 0, 1}, 0, 0, 0);
  const PatternMatch match =
      Match(DrawPrint(camera_, pattern_, SpokedPrint(pattern_, 4), pose), pose);
  EXPECT_GT(match.shares.arm[0], 0.9);
  EXPECT_GT(match.shares.arm[1], 0.9);
  EXPECT_LT(match.shares.arm[2], 0);
  EXPECT_GT(match.shares.arm[3], 0.9);
  const Print half = [this](double x, double y) {
    return SpokedPrint(pattern_, 4)(x, y) && (std::abs(y) < 0.06 || IsRing(pattern_, x, y));
  };
  EXPECT_FALSE(AgreesInAll(Match(DrawPrint(camera_, pattern_, half, pose), pose)));
}

TEST_F(PatternMatcherTest, AShadowBesideAnArmCostsLittle) {
  cv::Mat shaded = pattern_image_.clone();
  for (int v = 0; v < shaded.rows; ++v) {
    for (int u = 0; u < shaded.cols; ++u) {
      Eigen::Vector3d ray;
      camera_.Unproject({u, v}, &ray);
      const RigidTransform inverse = pose_.Inverse();
      const Eigen::Vector3d direction = inverse.rotation * ray;
      const Eigen::Vector3d point =
          inverse.translation - inverse.translation.z() / direction.z() * direction;
      auto& gray = shaded.at<std::uint8_t>(v, u);
      if (point.y() > 0.06) gray = static_cast<std::uint8_t>(0.3 * gray);
    }
  }
  const PatternMatch match = Match(shaded, pose_);
  for (int k = 0; k < 4; ++k) EXPECT_GT(match.shares.arm[k], 0.8) << k;
  EXPECT_GT(match.Agreement(), 0.8);
}

TEST_F(PatternMatcherTest, AShadowOverAHalfCostsLittle) {
  cv::Mat shaded = pattern_image_.clone();
  cv::Mat left = shaded.colRange(0, 168);
  left.convertTo(left, CV_8UC1, 0.6);
  EXPECT_GT(Match(shaded, pose_).Agreement(), 0.8);
}

TEST_F(PatternMatcherTest, WithoutContrastNothingAgrees) {
  const PatternMatch match = Match(cv::Mat(240, 320, CV_8UC1, cv::Scalar(100)), pose_);
  EXPECT_EQ(match.Agreement(), 0);
}

TEST_F(PatternMatcherTest, QuartersOutOfViewSayNothing) {
  const RigidTransform aside = PrintPose({1.55, 0, 2.2}, 0, 0, 0);
  const PatternMatch match =
      Match(DrawPrint(camera_, pattern_, SpokedPrint(pattern_, 4), aside), aside);
  EXPECT_LT(match.shares.arm[0], 0);
  EXPECT_LT(match.shares.ring[0], 0);
  EXPECT_GT(match.shares.arm[2], 0.9);
  EXPECT_LT(match.seen, 0.75);
  EXPECT_GT(match.Agreement(), 0.85);
}

TEST(PatternMatch, AgreementIsThatOfTheWorstKind) {
  PatternMatch match;
  match.shares.arm = {1, 1, 1, 1};
  match.shares.quadrant = {0.5, 0.5, 0.5, 0.5};
  match.shares.ring = {1, 1, 1, 0};  // a quarter of the ring may be lost
  EXPECT_DOUBLE_EQ(match.Agreement(), 0.5);
  match.shares.quadrant = {1, 1, 1, 1};
  EXPECT_DOUBLE_EQ(match.Agreement(), 1);
  match.shares.arm = {1, 1, 1, 0};  // an arm must not be lost
  EXPECT_DOUBLE_EQ(match.Agreement(), 0.75);
  match.shares.arm = {-1, -1, -1, -1};
  EXPECT_EQ(match.Agreement(), 0);
}

TEST(PartShares, WhatIsNotInViewCountsForNothing) {
  PartShares shares;
  shares.arm = {0.8, -1, 0.4, -1};
  shares.quadrant = {-1, -1, -1, -1};
  shares.ring = {0.9, 0.2, -1, 0.7};
  const PartShares::Means means = shares.MeansInView();
  EXPECT_DOUBLE_EQ(means.worst_arm, 0.4);
  EXPECT_DOUBLE_EQ(means.arms, 0.6);
  EXPECT_DOUBLE_EQ(means.quadrants, 1) << "none in view";
  EXPECT_DOUBLE_EQ(means.ring, 0.8) << "without its worst quarter";
  shares.arm.fill(-1);
  EXPECT_EQ(shares.MeansInView().worst_arm, 0) << "arms must be seen";
  EXPECT_EQ(shares.MeansInView().arms, 0);
}

}  // namespace
}  // namespace kestrel
