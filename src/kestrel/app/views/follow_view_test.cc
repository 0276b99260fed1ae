// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/views/follow_view.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(FollowViewTest, ShowsBoxWhileItIsSeenAndPredictedOneAfterwards) {
  FollowObservation seen;
  EXPECT_TRUE(FollowShapes(seen).empty());
  EXPECT_EQ(FollowStatus(seen).state, "not marked");
  seen.region = RegionReport{RegionState::kFollowing, {10, 20, 30, 40}, 0.9};
  ASSERT_EQ(FollowShapes(seen).size(), 1u);
  EXPECT_EQ(FollowShapes(seen)[0].layer, OverlayLayer::kDetection);
  EXPECT_EQ(FollowShapes(seen)[0].outline[2], cv::Point2f(40, 60));
  seen.region->state = RegionState::kCoasting;
  EXPECT_EQ(FollowShapes(seen)[0].layer, OverlayLayer::kPrediction);
  seen.region->state = RegionState::kLost;
  EXPECT_TRUE(FollowShapes(seen).empty()) << "its place is not known any more";
}

TEST(FollowViewTest, MapHasTrackAndSamplesHaveDistance) {
  FollowObservation seen;
  seen.region = RegionReport{RegionState::kFollowing, {10, 20, 30, 40}, 0.9};
  seen.world_from_camera = RigidTransform{Eigen::Quaterniond::Identity(), {0, 0, 10}};
  seen.bearing = Eigen::Vector3d(1, 0, 0);
  EXPECT_FALSE(FollowMap(seen).target);
  EXPECT_NE(FollowStatus(seen).reason, "");
  seen.target.emplace();
  EXPECT_TRUE(FollowMap(seen).target);
  ASSERT_EQ(FollowSample(seen).values.size(), FollowSeries().size());
  EXPECT_NEAR(FollowSample(seen).values[1], 10, 1e-9);
}

}  // namespace
}  // namespace kestrel
