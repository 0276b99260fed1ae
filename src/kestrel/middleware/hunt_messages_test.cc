// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/middleware/hunt_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/team/team_view.h"

namespace kestrel {
namespace {

const Time kSeen = TimeFromNanoseconds(5'000'000'000);

// A green disc that two have and one goes for, and something that the model has no class for.
TeamReport TwoObjects() {
  TeamReport team{kSeen, std::vector<TeamObject>(2)};
  TeamObject& disc = team.objects[0];
  disc.object.id = 3;
  disc.object.state.head<3>() << 1, 2, 0.1;
  disc.object.covariance(0, 0) = 0.04;
  disc.object.color_log_likelihoods[3] = 9;
  disc.uavs = {"one", "two"};
  disc.holder = "two";
  MappedObject& other = team.objects[1].object;
  other.shape = ObjectShape::kCuboid;
  other.color_log_likelihoods[2] = 9;  // yellow
  return team;
}

TEST(HuntMessages, TheTeamsMapHasClassPlaceAndCovariance) {
  const auto message = TeamDetectionsOf(TwoObjects(), DefaultObjectModel(), "map");
  EXPECT_EQ(message.header.frame_id, "map");
  EXPECT_EQ(message.header.stamp, kSeen);
  ASSERT_EQ(message.detections.size(), 1u);
  const Detection3DMessage& found = message.detections[0];
  EXPECT_EQ(found.id, "3");
  EXPECT_EQ(found.box_center.position.y, 2);
  ASSERT_EQ(found.results.size(), 1u);
  EXPECT_EQ(found.results[0].class_id, "green");
  EXPECT_EQ(found.results[0].score, 0.5);  // log-odds 0
  EXPECT_EQ(found.results[0].covariance[0], 0.04);
}

TEST(HuntMessages, TheTeamsMarkersSayWhoHasAnObjectAndWhoGoesForIt) {
  const auto message = TeamMarkersOf(TwoObjects(), DefaultObjectModel(), "map");
  ASSERT_EQ(message.markers.size(), 3u);
  EXPECT_EQ(message.markers[0].action, MarkerMessage::kDeleteAll);
  EXPECT_EQ(message.markers[1].type, MarkerMessage::kCube);
  EXPECT_EQ(message.markers[2].type, MarkerMessage::kText);
  EXPECT_EQ(message.markers[2].text, "green: one two, for two");
  EXPECT_GT(message.markers[2].pose.position.z, message.markers[1].pose.position.z);
}

}  // namespace
}  // namespace kestrel
