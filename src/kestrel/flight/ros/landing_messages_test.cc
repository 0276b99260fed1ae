// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/landing_messages.h"

#include <cmath>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

const Time kTrackTime = TimeFromNanoseconds(7'000'000'000);

// A target that drives north at 2 m/s and turns left. Standard deviation 0.1 m/s along, 0.2 m/s
// across.
TargetEstimate DrivingNorth() {
  TargetEstimate target;
  target.time = kTrackTime;
  target.motion.mean.head<7>() << 10, 20, 0.5, 0, 2, 0, 0.3;
  target.motion.covariance.diagonal().head<7>() << 1, 2, 3, 0.04, 0.01, 0.09, 0.16;
  target.motion.covariance(3, 6) = target.motion.covariance(6, 3) = 0.05;
  return target;
}

// REP 103 and nav_msgs/Odometry: the pose is in the world, the twist in the target's frame.
TEST(LandingMessages, TrackPointsInDirectionOfMotion) {
  const OdometryMessage track = TrackOf(DrivingNorth(), "map", "target");
  EXPECT_EQ(track.header.frame_id, "map");
  EXPECT_EQ(track.header.stamp, kTrackTime);
  EXPECT_EQ(track.child_frame_id, "target");
  EXPECT_EQ(track.pose.pose.position.y, 20);
  EXPECT_NEAR(track.pose.pose.orientation.z, std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(track.pose.pose.orientation.w, std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(track.twist.twist.linear.x, 2, 1e-9);
  EXPECT_NEAR(track.twist.twist.linear.y, 0, 1e-9);
  EXPECT_NEAR(track.twist.twist.angular.z, 0.3, 1e-9);
}

TEST(LandingMessages, TrackHasCovariancesInItsFrames) {
  const OdometryMessage track = TrackOf(DrivingNorth(), "map", "target");
  const auto pose = [&](int row, int column) { return track.pose.covariance[6 * row + column]; };
  const auto twist = [&](int row, int column) { return track.twist.covariance[6 * row + column]; };
  EXPECT_EQ(pose(0, 0), 1);
  EXPECT_EQ(pose(2, 2), 3);
  EXPECT_GT(pose(3, 3), 3);                             // roll is not known
  EXPECT_NEAR(pose(5, 5), std::pow(0.2 / 2, 2), 1e-9);  // variance of the velocity's direction
  EXPECT_NEAR(twist(0, 0), 0.01, 1e-9);                 // along
  EXPECT_NEAR(twist(1, 1), 0.04, 1e-9);                 // across
  EXPECT_NEAR(twist(5, 5), 0.16, 1e-9);
  EXPECT_NEAR(twist(1, 5), -0.05, 1e-9);  // to the left is west, -x of the world
  EXPECT_NEAR(twist(5, 1), -0.05, 1e-9);
}

TEST(LandingMessages, StandingTargetHasUnknownHeading) {
  TargetEstimate target = DrivingNorth();
  target.motion.mean.segment<3>(TurnState::kVelocity).setZero();
  EXPECT_GT(TrackOf(target, "map", "target").pose.covariance[35], 3);
}

TEST(LandingMessages, DetectionNamesPad) {
  LandingObservation observation;
  TargetDetection detection{};
  observation.report.detection = detection;
  const TargetShape shape = ShapeOf(LandingPattern());
  EXPECT_EQ(DetectionsOf(observation, "camera", shape).detections.at(0).id, "");
  observation.report.detection->id = 12;
  EXPECT_EQ(DetectionsOf(observation, "camera", shape).detections.at(0).id, "12");
}

TEST(LandingMessages, MissGivesEmptyListAndDeletesMarker) {
  LandingObservation observation;
  observation.time = kTrackTime;
  const auto detections = DetectionsOf(observation, "camera", ShapeOf(LandingPattern()));
  EXPECT_TRUE(detections.detections.empty());
  EXPECT_EQ(detections.header.frame_id, "camera");
  const auto markers = MarkersOf(observation, ShapeOf(LandingPattern()), "camera", "map").markers;
  ASSERT_EQ(markers.size(), 3);
  for (const MarkerMessage& marker : markers) EXPECT_EQ(marker.action, MarkerMessage::kDelete);
}

}  // namespace
}  // namespace kestrel
