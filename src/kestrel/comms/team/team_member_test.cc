// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/team_member.h"

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/team/test_team.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Key;
using ::testing::Le;
using ::testing::SizeIs;

constexpr int kTeam = 5;

SimulatedTeam TeamOfFive(std::uint64_t seed) {
  SimulatedTeam team(seed);
  for (int i = 0; i < kTeam; ++i) team.Add({std::string(1, static_cast<char>('a' + i)), 1});
  return team;
}

// Each UAV's map changes for a while: an object comes and goes, some are seen again.
void Fly(SimulatedTeam* team, double seconds, int objects = 20) {
  for (double t = 0; t < seconds; t += 0.1) {
    for (std::size_t i = 0; i < team->uavs.size(); ++i) {
      if (team->uavs[i].member == nullptr) continue;
      Random field(i);
      std::vector<MappedObject> map = TestField(objects, &field, team->now);
      const auto step = ToNanoseconds(team->now) / 500'000'000;
      map.erase(map.begin() + step % objects);
      for (MappedObject& object : map) {
        if (object.id % 4 == step % 4) object.detections += static_cast<int>(step % 1000);
        if (object.id % 4 != step % 4) object.first_seen = object.last_seen = object.time = Time();
      }
      team->uavs[i].member->Share(map, team->now);
    }
    team->Run(0.1);
  }
}

double UntilEqual(SimulatedTeam* team, double limit_s = 20) {
  return team->RunUntil([&] { return team->AreEqual(); }, limit_s);
}

void ExpectAllWhole(const SimulatedTeam& team, std::size_t parts) {
  for (const auto& uav : team.uavs) {
    if (uav.member == nullptr) continue;
    EXPECT_THAT(uav.member->map().parts(), SizeIs(parts));
    for (const auto& [key, part] : uav.member->map().parts()) EXPECT_THAT(part.objects, SizeIs(19));
  }
}

TEST(TeamMember, MapsAgreeSoonAfterLastChange) {
  SimulatedTeam team = TeamOfFive(1);
  Fly(&team, 5);
  EXPECT_LT(UntilEqual(&team), 1);
  ExpectAllWhole(team, kTeam);
}

TEST(TeamMember, DigestHasRoomForOwnTakenObjectsFirst) {
  SimulatedTeam team(1);
  for (const char* name : {"a", "b"}) team.Add({name, 1});
  for (auto& uav : team.uavs) {
    Random random(1);
    uav.member->Share(TestField(400, &random, team.now), team.now);
  }
  UntilEqual(&team, 60);
  TeamMember& member = *team.uavs[1].member;
  for (const char* name : {"a", "b"}) {
    for (std::int64_t id = 1; id <= 400; ++id) member.SetGone({{name, 1}, id}, team.LocalTime(1));
  }
  std::optional<TeamMessage> message;
  member.Tick(team.LocalTime(1) + std::chrono::seconds(2),
              [&](std::span<const std::uint8_t> bytes) {
                if (!message) message = ParseMessage(bytes);
              });
  ASSERT_TRUE(message);
  const auto& lines = std::get<Digest>(message->body);
  ASSERT_THAT(lines, SizeIs(2));
  EXPECT_THAT(lines[1].gone, SizeIs(400));
  EXPECT_THAT(lines[0].gone, SizeIs(kMaxGone - 400));
}

TEST(TeamMember, ObjectThatIsTakenAgainIsGoneSinceThen) {
  SimulatedTeam team(1);
  team.Add({"a", 1});
  TeamMember& member = *team.uavs[0].member;
  member.Share({TestDisc(1, {0, 0, 0}, team.now)}, team.now);
  team.Run(1);
  member.SetGone({{"a", 1}, 1}, team.now);
  team.Run(1);
  member.SetGone({{"a", 1}, 1}, team.now);
  const std::vector<TeamMember::Gone> gone = member.AllGone();
  ASSERT_EQ(gone.size(), 1u);
  EXPECT_EQ(gone[0].object, (ObjectRef{{"a", 1}, 1}));
  EXPECT_EQ(gone[0].since, team.now);
}

TEST(TeamMember, RecoversFromLossAndDelay) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SimulatedTeam team = TeamOfFive(seed);
    team.loss = 0.2;
    team.delay = std::chrono::milliseconds(200);
    Fly(&team, 5);
    EXPECT_LT(UntilEqual(&team), 4) << seed;
    ExpectAllWhole(team, kTeam);
  }
}

TEST(TeamMember, MapsAgreeASecondAfterLossesEnd) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SimulatedTeam team = TeamOfFive(seed);
    team.loss = 0.2;
    team.delay = std::chrono::milliseconds(200);
    Fly(&team, 5);
    team.loss = 0;
    EXPECT_LT(UntilEqual(&team), 1.2) << seed;
  }
}

TEST(TeamMember, MapsAgreeAfterPartition) {
  SimulatedTeam team = TeamOfFive(2);
  Fly(&team, 3);
  team.is_cut = [](std::size_t from, std::size_t to) { return (from < 2) != (to < 2); };
  Fly(&team, 30);
  EXPECT_FALSE(team.AreEqual());
  team.is_cut = [](auto, auto) { return false; };
  EXPECT_LT(UntilEqual(&team), 2.5);
  ExpectAllWhole(team, kTeam);
}

TEST(TeamMember, ForwardsUavThatIsHeardByOneOnly) {
  SimulatedTeam team = TeamOfFive(3);
  // 'a' hears nobody; later it hears only 'e', which hears all.
  team.is_cut = [](std::size_t /*from*/, std::size_t to) { return to == 0; };
  Fly(&team, 5);
  EXPECT_FALSE(team.AreEqual());
  team.is_cut = [](std::size_t from, std::size_t to) { return to == 0 && from != 4; };
  EXPECT_LT(UntilEqual(&team), 10);
  ExpectAllWhole(team, kTeam);
}

TEST(TeamMember, ForwardsPartOfLostUav) {
  SimulatedTeam team = TeamOfFive(4);
  team.uavs.pop_back();
  Fly(&team, 3);
  UntilEqual(&team);
  team.uavs[0].member.reset();
  team.Run(10);
  const std::size_t late = team.Add({"z", 1});
  Fly(&team, 2);
  EXPECT_LT(UntilEqual(&team), 4);
  EXPECT_THAT(team.uavs[late].member->map().Find({"a", 1})->objects, SizeIs(19));
}

TEST(TeamMember, RebootLosesNothing) {
  SimulatedTeam team = TeamOfFive(5);
  Fly(&team, 3);
  UntilEqual(&team);
  team.uavs[1].member = std::make_unique<TeamMember>(UavKey{"b", 99}, TeamOptions());
  Fly(&team, 3);
  EXPECT_LT(UntilEqual(&team), 2);
  ExpectAllWhole(team, kTeam + 1);
  for (const auto& uav : team.uavs) EXPECT_THAT(uav.warnings, IsEmpty());
}

TEST(TeamMember, WarnsOfTwoUavsWithSameName) {
  SimulatedTeam team = TeamOfFive(6);
  team.Add({"a", 2});
  Fly(&team, 5);
  EXPECT_LT(UntilEqual(&team), 1);
  ExpectAllWhole(team, kTeam + 1);
  EXPECT_THAT(team.uavs[0].warnings, ElementsAre(HasSubstr("another UAV is called 'a'")));
  EXPECT_THAT(team.uavs[5].warnings, SizeIs(1));
}

TEST(TeamMember, SendsLessThan10kBPerSecondWith100Objects) {
  SimulatedTeam team = TeamOfFive(7);
  team.loss = 0.2;
  Fly(&team, 20, 100);
  for (const auto& uav : team.uavs) {
    EXPECT_THAT(uav.sent_bytes / 20.0, Le(10'000));
    EXPECT_THAT(uav.largest, Le(kMaxTeamMessage + kSignatureSize));
  }
  EXPECT_LT(UntilEqual(&team), 6);
}

TEST(TeamMember, IgnoresStrangers) {
  SimulatedTeam team = TeamOfFive(8);
  Fly(&team, 2);
  Random random(8);
  for (int i = 0; i < 200; ++i) {
    std::vector<std::uint8_t> noise(random.Integer(0, 400));
    for (auto& byte : noise) byte = static_cast<std::uint8_t>(random.Integer(0, 255));
    team.Broadcast({}, noise);
  }
  team.Broadcast({}, std::vector<std::uint8_t>(100'000));
  // Sent under the name of 'a': an empty map of a later version, and a beat from far ahead.
  PartMessage map;
  map.uav = {"a", 1};
  map.contents.version = 1000;
  TeamMessage forged;
  forged.sender = map.uav;
  forged.body = map;
  team.Broadcast({}, EncodeMessage(forged));
  Digest digest(1);
  digest[0].uav = map.uav;
  digest[0].beat = 2'000'000'000;
  forged.body = digest;
  forged.sender = {"x", 1};
  team.Broadcast({}, EncodeMessage(forged));
  Fly(&team, 2);
  team.Run(8);
  EXPECT_TRUE(team.AreEqual());
  ExpectAllWhole(team, kTeam);
  EXPECT_GT(team.uavs[1].member->refused(), 200);
  EXPECT_THAT(team.uavs[0].warnings, SizeIs(2));  // the refused messages, and the forged map
  EXPECT_TRUE(team.uavs[1].member->IsAlive({"a", 1}, team.LocalTime(1)));
}

TEST(TeamMember, AcceptsOnlyMessagesSignedWithKey) {
  SimulatedTeam team(9);
  const TeamKey key{1, 2, 3};
  team.Add({"a", 1}, key);
  team.Add({"b", 1}, key);
  team.Add({"c", 1}, TeamKey{4});
  team.Add({"d", 1});
  Fly(&team, 3);
  UntilEqual(&team, 1);
  EXPECT_THAT(team.uavs[0].member->map().parts(),
              ElementsAre(Key(UavKey{"a", 1}), Key(UavKey{"b", 1})));
  EXPECT_THAT(team.uavs[2].member->map().parts(), SizeIs(1));
  EXPECT_THAT(team.uavs[3].member->map().parts(), SizeIs(1));
  EXPECT_THAT(team.uavs[0].warnings, ElementsAre(HasSubstr("not signed by the team's key")));
}

TEST(TeamMember, ChecksNamesAndOptions) {
  EXPECT_THROW(TeamMember({"two words", 1}, {}), InputError);
  EXPECT_THROW(TeamMember({"a", 1}, {.rate_bytes_per_s = -1}), InputError);
}

TEST(TeamMember, IsDoneWhenAllLiveMembersAreDone) {
  SimulatedTeam team(9);
  for (const char* name : {"a", "b", "c"}) team.Add({name, 1});
  const auto are_done = [&](std::size_t i) {
    return team.uavs[i].member->AreAllDone(team.LocalTime(i));
  };
  team.Run(1);
  team.uavs[0].member->SetDone();
  team.uavs[1].member->SetDone();
  team.Run(2);
  EXPECT_FALSE(are_done(0));
  EXPECT_FALSE(are_done(1));
  team.uavs[2].member.reset();  // falls silent
  team.Run(4);
  EXPECT_FALSE(are_done(0));
  team.Run(3);
  EXPECT_TRUE(are_done(0));
  EXPECT_TRUE(are_done(1));
}

// A UAV that declares its map the last one has sent that map before.
TEST(TeamMember, SendsLastMapBeforeDeclaringItLast) {
  SimulatedTeam team(10);
  team.Add({"a", 1});
  team.Add({"b", 1});
  TeamMember& first = *team.uavs[0].member;
  first.Share({TestDisc(1, {0, 0, 0}, team.now)}, team.now);
  team.Run(0.6);
  team.uavs[1].member->SetDone();
  first.Share({TestDisc(1, {0, 0, 0}, team.now), TestDisc(2, {1, 0, 0}, team.now)}, team.now);
  team.Run(0.05);
  first.Share({TestDisc(3, {5, 0, 0}, team.now)}, team.now);
  first.SetDone();
  team.RunUntil([&] { return team.uavs[1].member->AreAllDone(team.LocalTime(1)); }, 5);
  const TeamMap::Part* const part = team.uavs[1].member->map().Find({"a", 1});
  ASSERT_NE(part, nullptr);
  EXPECT_TRUE(part->contents.objects.contains(3));
}

}  // namespace
}  // namespace kestrel
