// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/hunt_messages.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/comms/team/team_view.h"

namespace kestrel {
namespace {

const Time kMapTime = TimeFromNanoseconds(9'000'000'000);
const Time kSeen = TimeFromNanoseconds(7'000'000'000);

// A disc of the model's first class, 0.2 m wide, with its upper face 12 mm above the ground. Its
// position is known to 0.1 m along x. It exists with a probability of 0.9.
MappedObject MappedDisc() {
  MappedObject object;
  object.id = 5;
  object.time = object.last_seen = kSeen;
  object.state.head<3>() << 10, 20, 0.012;
  object.covariance.diagonal().setConstant(0.04);
  object.covariance(0, 0) = 0.01;
  object.log_odds = std::log(9.0);
  object.color_log_likelihoods.fill(-50);
  object.color_log_likelihoods[DefaultObjectModel().classes[0].color] = 0;
  return object;
}

TEST(HuntMessages, TheMapSaysWhereEachObjectWasSeenLast) {
  const Detection3DArrayMessage map = MapOf({MappedDisc()}, kMapTime, DefaultObjectModel(), "map");
  EXPECT_EQ(map.header.stamp, kMapTime);
  EXPECT_EQ(map.header.frame_id, "map");
  ASSERT_EQ(map.detections.size(), 1);
  const Detection3DMessage& object = map.detections[0];
  EXPECT_EQ(object.header.stamp, kSeen);
  EXPECT_EQ(object.id, "5");
  ASSERT_EQ(object.results.size(), 1);
  const ObjectHypothesisMessage& result = object.results[0];
  EXPECT_EQ(result.id, 0);
  EXPECT_EQ(result.class_id, "red");
  EXPECT_NEAR(result.score, 0.9, 1e-9);
  EXPECT_EQ(result.pose.position.x, 10);
  EXPECT_EQ(result.pose.position.z, 0.012);
  EXPECT_EQ(result.covariance[0], 0.01);
  EXPECT_EQ(result.covariance[7], 0.04);
  EXPECT_GT(result.covariance[35], 3) << "nothing is known of how it is turned";
  // The box stands on the ground.
  EXPECT_EQ(object.box_size.x, 0.2);
  EXPECT_NEAR(object.box_center.position.z, 0.006, 1e-12);
}

TEST(HuntMessages, AnObjectWithoutAClassHasABoxAndNoHypothesis) {
  ObjectModel model = DefaultObjectModel();
  model.classes.clear();
  const Detection3DArrayMessage map = MapOf({MappedDisc()}, kMapTime, model, "map");
  ASSERT_EQ(map.detections.size(), 1);
  EXPECT_TRUE(map.detections[0].results.empty());
}

TEST(HuntMessages, MarkersOfTheMapReplaceThoseBeforeAndStay) {
  MappedObject moving = MappedDisc();
  moving.id = 6;
  moving.may_move = true;
  moving.state.segment<3>(3) << 1, 2, 0;
  const MarkerArrayMessage map =
      MapMarkersOf({MappedDisc(), moving}, kMapTime, DefaultObjectModel(), "map");
  ASSERT_EQ(map.markers.size(), 6);
  EXPECT_EQ(map.markers[0].action, MarkerMessage::kDeleteAll);
  EXPECT_EQ(map.markers[1].type, MarkerMessage::kCylinder);
  EXPECT_EQ(map.markers[1].id, 5);
  EXPECT_GT(map.markers[1].color.r, map.markers[1].color.b);
  EXPECT_EQ(map.markers[2].type, MarkerMessage::kText);
  EXPECT_EQ(map.markers[2].text, "red");
  const MarkerMessage& velocity = map.markers[5];
  EXPECT_EQ(velocity.type, MarkerMessage::kArrow);
  ASSERT_EQ(velocity.points.size(), 2);
  EXPECT_EQ(velocity.points[1].x, 11);
  EXPECT_EQ(velocity.points[1].y, 22);
  for (const MarkerMessage& marker : map.markers) {
    EXPECT_EQ(marker.header.frame_id, "map");
    EXPECT_EQ(marker.lifetime.seconds, 0);
  }
}

// The same disc in the maps of two UAVs, one of which claims it.
TeamReport TeamsDisc() { return {kMapTime, {{MappedDisc(), {"one", "two"}, "two"}}}; }

TEST(HuntMessages, TheTeamsMapIsOfOneTime) {
  const auto message = TeamDetectionsOf(TeamsDisc(), DefaultObjectModel(), "map");
  ASSERT_EQ(message.detections.size(), 1u);
  const Detection3DMessage& found = message.detections[0];
  EXPECT_EQ(found.header.stamp, kMapTime);
  EXPECT_EQ(found.id, "5");
  ASSERT_EQ(found.results.size(), 1u);
  EXPECT_EQ(found.results[0].class_id, "red");
  EXPECT_EQ(found.results[0].pose.position.y, 20);
}

TEST(HuntMessages, TheTeamsMarkersSayWhoHasAnObjectAndWhoGoesForIt) {
  TeamReport team = TeamsDisc();
  team.objects.push_back(team.objects.front());
  team.objects.back().holder = "";
  const auto message = TeamMarkersOf(team, DefaultObjectModel(), "map");
  ASSERT_EQ(message.markers.size(), 5u);
  EXPECT_EQ(message.markers[0].action, MarkerMessage::kDeleteAll);
  EXPECT_EQ(message.markers[2].text, "red: one two, for two");
  EXPECT_EQ(message.markers[4].text, "red: one two");
}

}  // namespace
}  // namespace kestrel
