// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/hunt_messages.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/comms/team/team_view.h"

namespace kestrel {
namespace {

const Time kMapTime = TimeFromNanoseconds(9'000'000'000);

// A disc of the model's first class, 0.2 m wide, with its upper face 12 mm above the ground. Its
// position is known to 0.1 m along x. It exists with a probability of 0.9.
MappedObject MappedDisc() {
  MappedObject object;
  object.id = 5;
  object.time = object.last_seen = TimeFromNanoseconds(7'000'000'000);
  object.state.head<3>() << 10, 20, 0.012;
  object.covariance.diagonal().setConstant(0.04);
  object.covariance(0, 0) = 0.01;
  object.log_odds = std::log(9.0);
  object.color_log_likelihoods.fill(-50);
  object.color_log_likelihoods[DefaultObjectModel().classes[0].color] = 0;
  return object;
}

// The same disc in the maps of two UAVs, one of which claims it.
TeamReport TeamsDisc() { return {kMapTime, {{MappedDisc(), {"one", "two"}, "two"}}}; }

TEST(HuntMessages, TeamMapHasOneTime) {
  const Detection3DArrayMessage map = TeamDetectionsOf(TeamsDisc(), DefaultObjectModel(), "map");
  EXPECT_EQ(map.header.stamp, kMapTime);
  EXPECT_EQ(map.header.frame_id, "map");
  ASSERT_EQ(map.detections.size(), 1);
  const Detection3DMessage& object = map.detections[0];
  EXPECT_EQ(object.header.stamp, kMapTime);
  EXPECT_EQ(object.id, "5");
  ASSERT_EQ(object.results.size(), 1);
  const auto& [hypothesis, location] = object.results[0];
  EXPECT_EQ(hypothesis.class_id, "red");
  EXPECT_NEAR(hypothesis.score, 0.9, 1e-9);
  EXPECT_EQ(location.pose.position.x, 10);
  EXPECT_EQ(location.pose.position.y, 20);
  EXPECT_EQ(location.pose.position.z, 0.012);
  EXPECT_EQ(location.pose.orientation.x, 0);
  EXPECT_EQ(location.pose.orientation.w, 1);
  EXPECT_EQ(location.covariance[0], 0.01);
  EXPECT_EQ(location.covariance[7], 0.04);
  EXPECT_GT(location.covariance[35], 3) << "nothing is known of how it is turned";
  // The box stands on the ground.
  EXPECT_EQ(object.box.size.x, 0.2);
  EXPECT_NEAR(object.box.center.position.z, 0.006, 1e-12);
}

TEST(HuntMessages, ObjectWithoutClassHasBoxAndNoHypothesis) {
  ObjectModel model = DefaultObjectModel();
  model.classes.clear();
  const Detection3DArrayMessage map = TeamDetectionsOf(TeamsDisc(), model, "map");
  ASSERT_EQ(map.detections.size(), 1);
  EXPECT_TRUE(map.detections[0].results.empty());
}

TEST(HuntMessages, TeamMarkersReplaceOldOnesAndNameOwners) {
  TeamReport team = TeamsDisc();
  team.objects.push_back(team.objects.front());
  team.objects.back().holder = "";
  const auto message = TeamMarkersOf(team, DefaultObjectModel(), "map");
  ASSERT_EQ(message.markers.size(), 5u);
  EXPECT_EQ(message.markers[0].action, MarkerMessage::kDeleteAll);
  EXPECT_EQ(message.markers[1].type, MarkerMessage::kCylinder);
  EXPECT_EQ(message.markers[1].id, 5);
  EXPECT_GT(message.markers[1].color.r, message.markers[1].color.b);
  EXPECT_EQ(message.markers[2].type, MarkerMessage::kText);
  EXPECT_EQ(message.markers[2].text, "red: one two, for two");
  EXPECT_EQ(message.markers[4].text, "red: one two");
  for (const MarkerMessage& marker : message.markers) {
    EXPECT_EQ(marker.header.frame_id, "map");
    EXPECT_EQ(marker.lifetime.sec, 0);
  }
}

}  // namespace
}  // namespace kestrel
