// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/ground_height.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

constexpr GroundHeight kGiven{0, 0.05};

using Sightings = std::vector<GroundHeight>;

void UpdateTimes(int times, const Sightings& seen, GroundHeightEstimator* ground) {
  for (int i = 0; i < times; ++i) ground->Update(kGiven, seen);
}

TEST(GroundHeightEstimator, KeepsGivenHeightThatAgreesWithSightings) {
  GroundHeightEstimator ground;
  UpdateTimes(20, {{0.1, 0.1}, {-0.2, 0.1}}, &ground);
  EXPECT_FALSE(ground.Contradiction());
  EXPECT_EQ(ground.Estimate(kGiven).height_m, kGiven.height_m);
}

TEST(GroundHeightEstimator, ConsistentSightingsContradictGivenHeight) {
  GroundHeightEstimator ground;
  UpdateTimes(4, {{9.9, 0.1}, {10.1, 0.1}}, &ground);
  EXPECT_FALSE(ground.Contradiction());
  EXPECT_TRUE(ground.Supports({10.2, 0.1}));
  EXPECT_FALSE(ground.Supports({11, 0.1}));
  UpdateTimes(1, {{9.9, 0.1}, {10.1, 0.1}}, &ground);
  ASSERT_TRUE(ground.Contradiction());
  EXPECT_NEAR(ground.Contradiction()->height_m, 10, 1e-9);
  EXPECT_NEAR(ground.Contradiction()->sigma_m, 0.11, 0.01) << "no surer than one, and what is told";
  EXPECT_NEAR(ground.Estimate(kGiven).height_m, 10, 1e-9);
}

TEST(GroundHeightEstimator, WeightsHeightByVariance) {
  GroundHeightEstimator ground;
  UpdateTimes(5, {{10, 0.1}, {10.4, 0.2}}, &ground);
  EXPECT_NEAR(ground.Estimate(kGiven).height_m, 10.08, 1e-9);
}

TEST(GroundHeightEstimator, FramesWithoutSightingChangeNothing) {
  GroundHeightEstimator ground;
  UpdateTimes(5, {{10, 0.1}}, &ground);
  UpdateTimes(100, {}, &ground);
  EXPECT_NEAR(ground.Estimate(kGiven).height_m, 10, 1e-9);
}

TEST(GroundHeightEstimator, InconsistentSightingsDoNotContradict) {
  GroundHeightEstimator ground;
  for (int i = 0; i < 30; ++i) ground.Update(kGiven, Sightings{{1.0 + i, 0.1}});
  EXPECT_FALSE(ground.Contradiction());
}

TEST(GroundHeightEstimator, MinorityDoesNotContradict) {
  GroundHeightEstimator ground;
  UpdateTimes(20, {{0, 0.1}, {0.1, 0.1}, {2, 0.1}}, &ground);
  EXPECT_FALSE(ground.Contradiction());
  EXPECT_FALSE(ground.Supports({2, 0.1}));
}

TEST(GroundHeightEstimator, ContradictionEndsWithItsSightings) {
  GroundHeightEstimator ground;
  UpdateTimes(10, {{10, 0.1}}, &ground);
  ASSERT_TRUE(ground.Contradiction());
  UpdateTimes(30, {{0, 0.1}}, &ground);
  EXPECT_FALSE(ground.Contradiction());
  EXPECT_EQ(ground.Estimate(kGiven).height_m, kGiven.height_m);
}

TEST(GroundHeightEstimator, IndependentFramesContradictTogether) {
  GroundHeightEstimator ground;
  for (int i = 0; i < 5; ++i) {
    ground.ForgetSightings();
    ground.Update(kGiven, Sightings{{10.0 + i, 0.1}});
  }
  ASSERT_TRUE(ground.Contradiction());
  EXPECT_NEAR(ground.Contradiction()->height_m, 14, 1e-9) << "by the last one alone";
}

TEST(GroundHeightEstimator, FrameWithoutFiniteSightingDoesNotContradict) {
  GroundHeightEstimator ground;
  UpdateTimes(4, {{10, 0.1}}, &ground);
  UpdateTimes(20, {{std::numeric_limits<double>::quiet_NaN(), 0.1}}, &ground);
  EXPECT_FALSE(ground.Contradiction());
}

TEST(GroundHeightEstimator, IgnoresNonFiniteSightings) {
  GroundHeightEstimator ground;
  const double infinity = std::numeric_limits<double>::infinity();
  UpdateTimes(5, {{10, 0.1}, {infinity, 0.1}, {10, infinity}}, &ground);
  EXPECT_NEAR(ground.Estimate(kGiven).height_m, 10, 1e-9);
}

}  // namespace
}  // namespace kestrel
