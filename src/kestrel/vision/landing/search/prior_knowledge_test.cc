// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/search/prior_knowledge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Normal of a level plane that the camera sees from above, tilted by 'angle' (rad) about x.
Vector3d UpTilted(double angle) {
  return Eigen::AngleAxisd(angle, Vector3d::UnitX()) * Vector3d(0, 0, -1);
}

class PriorKnowledgeTest : public ::testing::Test {
 protected:
  PriorKnowledge Of(const TargetHint& hint) const {
    return PriorKnowledge(hint, options_, camera_);
  }
  static TargetHint CenterAt(const Vector3d& center) {
    TargetHint hint;
    hint.center_in_camera = center;
    return hint;
  }

  const CameraModel camera_ = TestPrintCamera();
  const LandingPatternDetectorOptions options_{};
};

TEST_F(PriorKnowledgeTest, IsEmptyWithoutHint) {
  const TargetHint nothing;
  const PriorKnowledge prior = Of(nothing);
  EXPECT_FALSE(prior.PartOfImage(0.5));
  EXPECT_FALSE(prior.PredictedRing());
  EXPECT_FALSE(prior.LevelPrior(Vector3d(0, 0, -1)));
  EXPECT_EQ(prior.LogOddsOfDistance({1, 2, 30}), 0);
  EXPECT_TRUE(std::all_of(kSteps.begin(), kSteps.end(),
                          [&](const SearchStep& step) { return prior.Suits(step); }));
  EXPECT_EQ(prior.Up(), Vector3d(0, 0, -1)) << "the camera looks straight down";
}

TEST_F(PriorKnowledgeTest, PartOfImageContainsBoard) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const double distance = random.Uniform(0.5, 12);
    const double sigma_m = random.Uniform(0, 0.3);
    const RigidTransform truth = PrintPose(
        {random.Uniform(-0.6, 0.6) * distance, random.Uniform(-0.4, 0.4) * distance, distance},
        random.Uniform(0, 0.5), random.Uniform(0, 6), random.Uniform(0, 6));
    Vector3d given = truth.translation;
    for (int k = 0; k < 2; ++k) given(k) += random.Uniform(-1, 1) * sigma_m;
    const TargetHint hint = CenterAt(given);
    const auto part = Of(hint).PartOfImage(sigma_m);
    ASSERT_TRUE(part);
    const cv::Rect image(0, 0, camera_.width_px(), camera_.height_px());
    EXPECT_EQ(*part & image, *part) << "within the image";
    EXPECT_EQ(part->x % 32, 0) << "whole tiles";
    EXPECT_EQ(part->y % 32, 0);
    for (double angle = 0; angle < 6; angle += 0.2) {
      Eigen::Vector2d pixel;
      camera_.Project(truth * Vector3d(0.5 * std::cos(angle), 0.5 * std::sin(angle), 0), &pixel);
      const cv::Point at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
      EXPECT_TRUE(!image.contains(at) || part->contains(at)) << trial;
    }
  }
}

TEST_F(PriorKnowledgeTest, InvalidHintGivesNoPart) {
  for (const Vector3d& center : {Vector3d(0, 0, 0), Vector3d(0, 0, -2), Vector3d(kNan, 0, 1),
                                 Vector3d(500, 0, 1), Vector3d(0, 1e9, 1e-9)}) {
    const TargetHint hint = CenterAt(center);
    EXPECT_FALSE(Of(hint).PartOfImage(0.1)) << center.transpose();
  }
  const TargetHint hint = CenterAt({0, 0, 3});
  EXPECT_FALSE(Of(hint).PartOfImage(kNan));
}

TEST_F(PriorKnowledgeTest, PredictsRingOnlyWithKnownPlaneFromAbove) {
  TargetHint hint = CenterAt({0.1, 0, 3});
  EXPECT_FALSE(Of(hint).PredictedRing()) << "nothing is known of its plane";
  hint.up_in_camera = UpTilted(0.2);
  const auto ring = Of(hint).PredictedRing();
  ASSERT_TRUE(ring);
  EXPECT_EQ(ring->center, *hint.center_in_camera);
  EXPECT_EQ(ring->normal, *hint.up_in_camera);
  hint.up_in_camera = -*hint.up_in_camera;
  EXPECT_FALSE(Of(hint).PredictedRing());
  hint.up_in_camera = Vector3d(kNan, 0, 0);
  EXPECT_FALSE(Of(hint).PredictedRing());
}

TEST_F(PriorKnowledgeTest, SuitableStepsFindRingsOfPredictedSize) {
  // 220 px/m at 1 m: a ring of 22 px at 10 m, of 220 px at 1 m.
  for (const double distance : {1.0, 3.0, 10.0}) {
    const TargetHint hint = CenterAt({0, 0, distance});
    const PriorKnowledge prior = Of(hint);
    const double ring_px = 220 / distance;
    int suits = 0;
    for (const SearchStep& step : kSteps) {
      const SearchPass& pass = kPasses[step.pass];
      if (!prior.Suits(step)) continue;
      ++suits;
      EXPECT_GE(ring_px, pass.min_ring_px) << distance;
      EXPECT_LE(ring_px, 1.2 * pass.max_ring_px) << distance;
    }
    EXPECT_GT(suits, 2) << distance;
    EXPECT_LT(suits, static_cast<int>(kSearchSteps)) << distance;
  }
  TargetHint high;
  high.altitude_m = options_.max_partial_altitude_m + 1;
  EXPECT_FALSE(Of(high).Suits({0, SearchMethod::kCross}));
  TargetHint low;
  low.altitude_m = 1;
  EXPECT_TRUE(Of(low).Suits({0, SearchMethod::kCross}));
}

TEST_F(PriorKnowledgeTest, WrongDistanceLowersOddsAndNoneRaisesThem) {
  TargetHint hint = CenterAt({0, 0, 5});
  hint.center_sigma_m = 0.2;
  EXPECT_EQ(Of(hint).LogOddsOfDistance({0, 0, 5.5}), 0);
  EXPECT_LT(Of(hint).LogOddsOfDistance({0, 0, 10}), -1);
  EXPECT_LT(Of(hint).LogOddsOfDistance({0, 0, 2}), -1);
  TargetHint altitude;
  altitude.altitude_m = 6;
  EXPECT_EQ(Of(altitude).LogOddsOfDistance({1, 0, 6}), 0);
  EXPECT_LT(Of(altitude).LogOddsOfDistance({0, 0, 0.5}), -1);
  altitude.up_in_camera = UpTilted(0.5);
  EXPECT_EQ(Of(altitude).LogOddsOfDistance(-6 * UpTilted(0.5)), 0);
  EXPECT_LT(Of(altitude).LogOddsOfDistance(-20 * UpTilted(0.5)), -1);
  // The effect of the hint is bounded, so the image can outweigh it.
  Random random(2);
  for (int trial = 0; trial < 300; ++trial) {
    TargetHint any =
        CenterAt({random.Uniform(-9, 9), random.Uniform(-9, 9), random.Uniform(-9, 9)});
    any.altitude_m = trial % 7 == 0 ? kNan : random.Uniform(-600, 600);
    if (trial % 2) any.up_in_camera = UpTilted(random.Uniform(0, 6));
    const double log_odds = Of(any).LogOddsOfDistance(
        {random.Uniform(-3, 3), random.Uniform(-3, 3), random.Uniform(0.3, 12)});
    EXPECT_LE(log_odds, 0);
    EXPECT_GE(log_odds, -2.5);
  }
}

TEST_F(PriorKnowledgeTest, TestsLevelPoseFirst) {
  const CirclePose level{{0, 0, 5}, UpTilted(0)}, tilted{{0, 0, 5}, UpTilted(0.6)};
  TargetHint hint;
  hint.up_in_camera = UpTilted(0.05);
  const PriorKnowledge prior = Of(hint);
  const PriorKnowledge::Order first = prior.OrderOf({level, tilted});
  EXPECT_EQ(first.poses, (std::array<int, 2>{0, 1}));
  EXPECT_TRUE(first.one_is_right);
  const PriorKnowledge::Order second = prior.OrderOf({tilted, level});
  EXPECT_EQ(second.poses, (std::array<int, 2>{1, 0}));
  EXPECT_TRUE(second.one_is_right);
}

TEST_F(PriorKnowledgeTest, KeepsBothPosesWhenAttitudeIsUndecided) {
  const CirclePose a{{0, 0, 5}, UpTilted(0.3)}, b{{0, 0, 5}, UpTilted(-0.3)};
  const TargetHint nothing;
  EXPECT_FALSE(Of(nothing).OrderOf({a, b}).one_is_right);
  TargetHint between;
  between.up_in_camera = UpTilted(0.01);
  EXPECT_FALSE(Of(between).OrderOf({a, b}).one_is_right) << "one is as level as the other";
  TargetHint upside_down;
  upside_down.up_in_camera = -UpTilted(0.3);
  EXPECT_FALSE(Of(upside_down).OrderOf({a, b}).one_is_right) << "neither is level";
  // For any hint, the order contains both poses.
  Random random(3);
  for (int trial = 0; trial < 100; ++trial) {
    TargetHint any;
    any.up_in_camera = trial == 0 ? Vector3d(kNan, 0, 0) : UpTilted(random.Uniform(0, 6));
    const auto order = Of(any).OrderOf({a, b});
    EXPECT_EQ(order.poses[0] + order.poses[1], 1);
  }
}

TEST_F(PriorKnowledgeTest, ContradictoryPlaneHasNoPrior) {
  TargetHint hint;
  hint.up_in_camera = UpTilted(0.1);
  const auto prior = Of(hint).LevelPrior(UpTilted(0.3));
  ASSERT_TRUE(prior);
  EXPECT_EQ(prior->normal_in_camera, *hint.up_in_camera);
  EXPECT_NEAR(prior->sigma, options_.level_sigma_deg * std::numbers::pi / 180, 1e-12);
  EXPECT_FALSE(Of(hint).LevelPrior(UpTilted(1.2)));
  EXPECT_FALSE(Of(hint).LevelPrior(-UpTilted(0.1)));
  hint.up_in_camera = Vector3d(kNan, 0, 0);
  EXPECT_FALSE(Of(hint).LevelPrior(UpTilted(0.1)));
}

}  // namespace
}  // namespace kestrel
