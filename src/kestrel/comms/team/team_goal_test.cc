// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/team_goal.h"

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/team/test_team.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

// UAVs with the objects that each of them sees, who choose four times a second.
struct Team {
  explicit Team(std::size_t count) : radio(1) {
    for (std::size_t i = 0; i < count; ++i) {
      radio.Add({std::string(1, static_cast<char>('a' + i)), 1});
      uavs.push_back(
          {{},
           {},
           TeamFusion({}, {}),
           GoalChooser(DefaultObjectModel(), "red"),
           {.at = UavFlight{Vector3d(20.0 * static_cast<double>(i), 0, 6)}, .wants_object = true}});
    }
  }

  void Run(double seconds) {
    for (double t = 0; t < seconds; t += 0.25) {
      for (std::size_t i = 0; i < uavs.size(); ++i) Choose(i);
      radio.Run(0.25);
    }
  }
  void Choose(std::size_t i) {
    Uav& uav = uavs[i];
    TeamMember& member = *radio.uavs[i].member;
    const Time local = radio.LocalTime(i);
    for (MappedObject& object : uav.map) object.time = object.last_seen = local;
    if (uav.sees) member.Share(uav.map, local);
    member.SetFlight(uav.flight.at);
    uav.goal = uav.chooser.Update(ViewTeam(member, local, &uav.fusion), uav.flight, local, &member);
  }
  void Leave(std::size_t i, bool is_taken) {
    uavs[i].flight.ended = uavs[i].goal.number;
    uavs[i].flight.has_taken = is_taken;
  }

  struct Uav {
    std::vector<MappedObject> map;
    TeamGoal goal;
    TeamFusion fusion;
    GoalChooser chooser;
    FlightToObjects flight;
    bool sees = true;  // its map is news
  };
  SimulatedTeam radio;
  std::vector<Uav> uavs;
};

// The colour by the number modulo 5: red.
MappedObject Red(std::int64_t number, const Vector3d& place) {
  return TestDisc(5 * number, place, Time());
}

TEST(TeamGoalTest, UavsGoToObjectsThatAreApart) {
  Team team(2);
  // Two near each other, one far away, which the first UAV alone sees.
  team.uavs[0].map = {Red(1, {5, 0, 0}), Red(2, {8, 0, 0}), Red(3, {30, 0, 0})};
  team.Run(2);
  ASSERT_NE(team.uavs[0].goal.number, 0);
  ASSERT_NE(team.uavs[1].goal.number, 0);
  EXPECT_NEAR(team.uavs[0].goal.object.position().x(), 5, 0.1);
  EXPECT_NEAR(team.uavs[1].goal.object.position().x(), 30, 0.1);
  EXPECT_EQ(team.uavs[0].goal.own_id, 5);
  EXPECT_EQ(team.uavs[1].goal.own_id, 0);
}

TEST(TeamGoalTest, NobodyGoesToObjectThatWasTaken) {
  Team team(2);
  team.uavs[0].map = {Red(1, {5, 0, 0})};
  team.uavs[1].map = {Red(1, {5, 0, 0})};
  team.Run(2);
  ASSERT_NE(team.uavs[0].goal.number, 0);
  EXPECT_EQ(team.uavs[1].goal.number, 0);
  // The second UAV does not look there any more, and keeps it in its map.
  team.uavs[0].map.clear();
  team.uavs[1].sees = false;
  team.Leave(0, /*is_taken=*/true);
  team.Run(8);
  EXPECT_EQ(team.uavs[0].goal.number, 0);
  EXPECT_EQ(team.uavs[1].goal.number, 0);
}

TEST(TeamGoalTest, ObjectThatIsSeenLongAfterIsThere) {
  Team team(1);
  team.uavs[0].map = {Red(1, {5, 0, 0})};
  team.Run(1);
  team.Leave(0, /*is_taken=*/true);
  team.Run(2);
  EXPECT_EQ(team.uavs[0].goal.number, 0);
  team.Run(3);
  EXPECT_NE(team.uavs[0].goal.number, 0);
}

TEST(TeamGoalTest, ObjectThatIsLeftIsForTheOthers) {
  Team team(2);
  team.uavs[0].map = {Red(1, {5, 0, 0})};
  team.Run(2);
  team.Leave(0, /*is_taken=*/false);
  team.Run(2);
  EXPECT_EQ(team.uavs[0].goal.number, 0);
  EXPECT_NE(team.uavs[1].goal.number, 0);
}

TEST(TeamGoalTest, ObjectThatIsLeftIsTriedAgainInTheNextFlight) {
  Team team(1);
  team.uavs[0].map = {Red(1, {5, 0, 0})};
  team.Run(1);
  team.Leave(0, /*is_taken=*/false);
  team.Run(1);
  const auto at = std::exchange(team.uavs[0].flight.at, std::nullopt);
  team.Run(1);
  team.uavs[0].flight.at = at;
  team.Run(1);
  EXPECT_NE(team.uavs[0].goal.number, 0);
}

TEST(TeamGoalTest, JobThatEndsWhileThereIsNoGoalIsReported) {
  Team team(2);
  team.uavs[0].map = {Red(1, {5, 0, 0})};
  team.Run(2);
  const int number = team.uavs[0].goal.number;
  team.uavs[0].flight.wants_object = false;
  team.Run(1);
  EXPECT_EQ(team.uavs[0].goal.number, 0);
  ASSERT_NE(team.uavs[1].goal.number, 0);
  team.uavs[0].sees = false;
  team.uavs[0].flight.ended = number;
  team.uavs[0].flight.has_taken = true;
  team.Run(1);
  EXPECT_EQ(team.uavs[1].goal.number, 0);
}

TEST(TeamGoalTest, ObjectKeepsItsNumber) {
  Team team(1);
  team.uavs[0].map = {Red(1, {5, 0, 0})};
  team.Run(1);
  const int number = team.uavs[0].goal.number;
  team.uavs[0].flight.wants_object = false;
  team.Run(1);
  team.uavs[0].flight.wants_object = true;
  team.Run(1);
  EXPECT_EQ(team.uavs[0].goal.number, number);
}

TEST(TeamGoalTest, ObjectThatMayBeAnywhereIsNotChosen) {
  Team team(1);
  team.uavs[0].map = {TestDisc(5, {5, 0, 0}, Time(), /*sigma_m=*/4)};
  team.Run(1);
  EXPECT_EQ(team.uavs[0].goal.number, 0);
}

TEST(TeamGoalTest, LayerAndPlacesOutlastTheRadio) {
  Team team(2);
  team.uavs[0].flight.at->velocity = {1, 0, 0};
  team.Run(2);
  EXPECT_EQ(team.uavs[1].goal.rank, 1);
  team.radio.is_cut = [](auto, auto) { return true; };
  team.Run(4);
  ASSERT_EQ(team.uavs[1].goal.mates.size(), 1u);
  EXPECT_NEAR(team.uavs[1].goal.mates[0].position.x(), 2, 0.3);  // of 2 s
  EXPECT_EQ(team.uavs[1].goal.time, team.radio.LocalTime(1) - std::chrono::milliseconds(250));
  team.Run(6);
  EXPECT_TRUE(team.uavs[1].goal.mates.empty());
  EXPECT_EQ(team.uavs[1].goal.rank, 1);
  team.uavs[1].flight.at.reset();
  team.Run(0.25);
  EXPECT_EQ(team.uavs[1].goal.rank, 0);
}

TEST(TeamGoalTest, UavAtWorkGoesFirst) {
  Team team(2);
  team.uavs[1].flight.at->velocity = {1, 0, 0};
  team.Run(1);
  ASSERT_EQ(team.uavs[0].goal.mates.size(), 1u);
  EXPECT_NEAR(team.uavs[0].goal.mates[0].position.x(), 20, 0.5);
  EXPECT_FALSE(team.uavs[0].goal.mates[0].goes_first);
  EXPECT_TRUE(team.uavs[1].goal.mates[0].goes_first);
  EXPECT_EQ(team.uavs[1].goal.rank, 1);
  team.uavs[1].flight.at->is_at_work = true;
  team.Run(1);
  EXPECT_TRUE(team.uavs[0].goal.mates[0].goes_first);
  EXPECT_FALSE(team.uavs[1].goal.mates[0].goes_first);
}

}  // namespace
}  // namespace kestrel
