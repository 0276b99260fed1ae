// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/team_map.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/team/test_team.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Key;
using ::testing::SizeIs;

// Returns a UAV's messages while its map changes: objects come, move and go.
std::vector<PartMessage> Reported(const UavKey& uav, Random* random) {
  std::vector<PartMessage> messages;
  std::map<std::int64_t, std::uint64_t> versions;
  for (std::uint64_t version = 1; version <= 6; ++version) {
    PartMessage message{uav, {}, {version, Time(std::chrono::seconds(version)), {}}, {}};
    for (std::int64_t id = 1; id <= 6; ++id) {
      if (random->Chance(0.3)) versions.erase(id);
      if (!random->Chance(0.5)) continue;
      versions[id] = version;
      message.objects.push_back(*AsReported(
          TestDisc(id, {random->Normal(), 0, 0}, message.contents.now), message.contents.now));
    }
    message.contents.objects = versions;
    messages.push_back(message);
  }
  return messages;
}

TEST(TeamMap, IsIndependentOfOrderAndRepetitionOfMessages) {
  Random random(1);
  for (int i = 0; i < 30; ++i) {
    std::vector<PartMessage> messages = Reported({"a", 1}, &random);
    for (const PartMessage& message : Reported({"b", 1}, &random)) messages.push_back(message);
    TeamMap in_order;
    for (const PartMessage& message : messages) in_order.Merge(message, Time());
    TeamMap shuffled;
    for (int k = 0; k < 3; ++k) {
      for (std::size_t j = messages.size() - 1; j > 0; --j) {
        std::swap(messages[j], messages[random.Integer(0, static_cast<int>(j))]);
      }
      for (const PartMessage& message : messages) shuffled.Merge(message, Time());
    }
    EXPECT_EQ(TextOf(in_order), TextOf(shuffled));
    for (const auto& [uav, part] : in_order.parts()) EXPECT_THAT(part.Missing(9), IsEmpty());
  }
}

TEST(TeamMap, RemovesUnlistedObjectsForGood) {
  TeamMap map;
  const UavKey uav{"a", 1};
  PartMessage with;
  with.uav = uav;
  with.contents.version = 1;
  with.contents.objects[1] = 1;
  with.objects = {TestDisc(1, {0, 0, 0}, Time())};
  map.Merge(with, Time());
  EXPECT_THAT(map.Find(uav)->objects, ElementsAre(Key(1)));
  PartMessage without;
  without.uav = uav;
  without.contents.version = 2;
  map.Merge(without, Time());
  map.Merge(with, Time());
  EXPECT_THAT(map.Find(uav)->objects, IsEmpty());
}

TEST(TeamMap, ListsMissingObjects) {
  TeamMap map;
  const UavKey uav{"a", 1};
  PartMessage part;
  part.uav = uav;
  part.contents.version = 4;
  part.contents.objects = {{1, 1}, {2, 4}, {3, 2}};
  part.objects = {TestDisc(2, {0, 0, 0}, Time())};
  map.Merge(part, Time());
  EXPECT_THAT(map.Find(uav)->Missing(9), ElementsAre(1, 3));
  EXPECT_THAT(map.Find(uav)->Missing(1), ElementsAre(1));
}

TEST(TeamMap, LimitsUavs) {
  TeamMap map;
  PartMessage part;
  part.uav.name = "a";
  for (; part.uav.boot < 1000; ++part.uav.boot) map.Merge(part, Time());
  EXPECT_THAT(map.parts(), SizeIs(kMaxUavs));
}

}  // namespace
}  // namespace kestrel
