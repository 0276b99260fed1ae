// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/pad_place.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/onboard/pad_position.h"

namespace kestrel {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond Turn(double degrees) {
  return Quaterniond(Eigen::AngleAxisd(Radians(degrees), Vector3d::UnitZ()));
}

// A pad with a cross in the world's origin, turned by 20 degrees, and a UAV over it.
class PadPlaceTest : public testing::Test {
 protected:
  // 'looks_turned': quarters by which the detector takes the pad to be turned.
  TrackSnapshot::Sight See(const RigidTransform& world_from_body, int looks_turned = 0) {
    time_ += std::chrono::milliseconds(50);
    TrackSnapshot::Sight sight;
    sight.time = time_;
    const RigidTransform world_from_target{Turn(20 + 90 * looks_turned), pad_};
    sight.target_from_body = world_from_target.Inverse() * world_from_body;
    sight.covariance = 1e-4 * Eigen::Matrix3d::Identity();
    sight.heading_sigma = 0.01;
    sight.heading_symmetry = 4;
    return sight;
  }

  Time time_ = TimeFromNanoseconds(1'000'000'000);
  Vector3d pad_{0, 0, 0};
  PadPlace place_;
};

TEST_F(PadPlaceTest, IsRelativeToPadInAxesOfAutopilot) {
  const Quaterniond lean(Eigen::AngleAxisd(0.2, Vector3d(1, 2, 0).normalized()));
  const RigidTransform body{Turn(70) * lean, {1, -2, 5}};
  for (const HeadingSource source : {HeadingSource::kAutopilot, HeadingSource::kPad}) {
    const ExternalPose pose = PadPlace().Update(See(body), body.rotation, source);
    EXPECT_LT((pose.frame_from_body.translation - body.translation).norm(), 1e-9);
    EXPECT_LT(pose.frame_from_body.rotation.angularDistance(body.rotation), 1e-9);
  }
}

TEST_F(PadPlaceTest, FollowsHeadingOfEstimator) {
  const RigidTransform body{Turn(70), {1, -2, 5}};
  place_.Update(See(body), body.rotation, HeadingSource::kPad);
  // A steel deck turns the compass by 40 degrees.
  const Quaterniond disturbed = Turn(110);
  const ExternalPose by_pad = place_.Update(See(body), disturbed, HeadingSource::kPad);
  EXPECT_LT((by_pad.frame_from_body.translation - body.translation).norm(), 1e-9);
  EXPECT_NEAR(HeadingOf(by_pad.frame_from_body.rotation), Radians(70), 1e-9);
  EXPECT_NEAR(place_.heading_drift(), Radians(40), 1e-9);
  // An estimator that goes by the compass takes its whole world to be turned.
  const ExternalPose by_compass = place_.Update(See(body), disturbed, HeadingSource::kAutopilot);
  EXPECT_LT((by_compass.frame_from_body.translation - Turn(40) * body.translation).norm(), 1e-9);
}

TEST_F(PadPlaceTest, KeepsQuarterThatPadWasSeenInFirst) {
  for (int i = 0; i < 40; ++i) {
    const RigidTransform body{Turn(70 + 10 * i), {1, -2, 5}};
    const ExternalPose pose = place_.Update(See(body, i % 4), body.rotation, HeadingSource::kPad);
    EXPECT_LT((pose.frame_from_body.translation - body.translation).norm(), 1e-9) << i;
  }
  EXPECT_EQ(place_.resets(), 0);
}

// The ring shows one of four headings; its tags, from nearer, the true one.
TEST_F(PadPlaceTest, KeepsHeadingWhenTagsAppearInRing) {
  const RigidTransform body{Turn(70), {1, -2, 5}};
  place_.Update(See(body, 1), body.rotation, HeadingSource::kPad);
  TrackSnapshot::Sight by_tags = See(body);
  by_tags.heading_symmetry = 1;
  const ExternalPose pose = place_.Update(by_tags, body.rotation, HeadingSource::kPad);
  EXPECT_LT((pose.frame_from_body.translation - body.translation).norm(), 1e-9);
  EXPECT_NEAR(place_.heading_drift(), 0, 1e-9);
}

TEST_F(PadPlaceTest, CountsOtherPadAsReset) {
  const RigidTransform body{Turn(0), {0, 0, 4}};
  EXPECT_EQ(place_.Update(See(body), body.rotation, HeadingSource::kAutopilot).resets, 0);
  pad_.x() = 2;
  EXPECT_EQ(place_.Update(See(body), body.rotation, HeadingSource::kAutopilot).resets, 1);
  EXPECT_EQ(place_.Update(See(body), body.rotation, HeadingSource::kAutopilot).resets, 1);
}

TEST_F(PadPlaceTest, CovarianceHoldsErrorOfAttitude) {
  constexpr int kTrials = 2000;
  Random random(3);
  const RigidTransform body{Turn(70), {1, -2, 5}};
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  ExternalPose pose;
  for (int i = 0; i < kTrials; ++i) {
    const Vector3d error(Radians(random.Normal()), Radians(random.Normal()), 0);
    pose =
        PadPlace().Update(See(body), RotationBy(error) * body.rotation, HeadingSource::kAutopilot);
    const Vector3d off = pose.frame_from_body.translation - body.translation;
    sum += off * off.transpose() / kTrials;
  }
  sum += 1e-4 * Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(sum(i, i) / pose.covariance(i, i), 1, 0.15) << i;
}

TEST(ParseGlobalPosition, ReadsPlacesOnEarthOnly) {
  const auto origin = ParseGlobalPosition("47.5,-8.25");
  ASSERT_TRUE(origin);
  EXPECT_EQ(origin->latitude_e7, 475000000);
  EXPECT_EQ(origin->longitude_e7, -82500000);
  for (const char* text : {"", "47.5", "47.5,", "91,8", "47,181", "nan,8", "0,0", "a,b", "1,2,3"}) {
    EXPECT_FALSE(ParseGlobalPosition(text)) << text;
  }
}

}  // namespace
}  // namespace kestrel
