// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/team_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/team/test_team.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/mapping/map_file.h"

namespace kestrel {
namespace {

using ::testing::Each;
using ::testing::Ne;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

// A team over one field of 60 objects; each UAV has 40 of them and, unless 'bias_m' is 0, a
// navigation error of its own.
struct FieldTeam {
  FieldTeam(int count, double bias_m, std::uint64_t seed) : team(seed) {
    Random random(seed);
    field = TestField(60, &random);
    fusions.resize(count, TeamFusion({}, {}));
    for (int i = 0; i < count; ++i) {
      WorldAlignment& world = worlds.emplace_back();
      world.pivot = {50, 50, 0};
      world.translation = bias_m * Eigen::Vector3d{random.Normal(), random.Normal(), 0};
      world.yaw = bias_m * Radians(2) * random.Uniform(-1, 1);
      team.Add({std::string(1, static_cast<char>('a' + i)), 1});
      std::vector<MappedObject> seen;
      for (int k = 0; k < 40; ++k) {
        MappedObject object = field[(12 * i + k) % 60];
        object.state.head<3>() = worlds.back() * object.position() +
                                 0.05 * Eigen::Vector3d{random.Normal(), random.Normal(), 0};
        seen.push_back(object);
      }
      team.uavs[i].member->Share(seen, Time());
    }
    team.Run(3);
  }

  TeamView View(std::size_t i) {
    return ViewTeam(*team.uavs[i].member, team.LocalTime(i), &fusions[i]);
  }

  SimulatedTeam team;
  std::vector<MappedObject> field;
  std::vector<WorldAlignment> worlds;
  std::vector<TeamFusion> fusions;
};

TEST(TeamView, CommonMapIsBitIdenticalForAll) {
  FieldTeam flown(3, 1, 4);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < 3; ++i) {
    const TeamView view = flown.View(i);
    std::string& text = texts.emplace_back();
    for (const TeamObject& common : CommonMap(*flown.team.uavs[i].member, view, flown.fusions[i])) {
      std::vector<MappedObject> object{common.object};
      object[0].time = object[0].first_seen = object[0].last_seen = Time();
      text += PrintObjects(object);
      for (const std::string& uav : common.uavs) text += uav + '\n';
      text += common.holder;
    }
    EXPECT_GT(text.size(), 10'000u);
    EXPECT_EQ(text, texts[0]);
  }
}

TEST(TeamView, EveryUavSeesEachObjectOnceInItsOwnWorld) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    FieldTeam flown(5, 1, seed);
    for (std::size_t i = 0; i < 5; ++i) {
      const TeamView view = flown.View(i);
      EXPECT_THAT(view.common_from_world, SizeIs(5)) << seed;
      ASSERT_THAT(view.objects, SizeIs(60)) << seed;
      double sum = 0;
      for (const MappedObject& object : flown.field) {
        const Eigen::Vector3d truth = flown.worlds[i] * object.position();
        double nearest = 1e9;
        for (const MappedObject& seen : view.objects) {
          nearest = std::min(nearest, (seen.position() - truth).norm());
        }
        sum += nearest;
      }
      EXPECT_LT(sum / 60, 0.1) << seed;
    }
  }
}

// A living UAV and one that is gone report a moving object at different times.
TEST(TeamView, ObjectsArePredictedToTimeOfView) {
  SimulatedTeam team(1);
  team.Add({"a", 1});
  team.Add({"b", 1});
  MappedObject moving = TestDisc(1, {0, 0, 0}, Time());
  moving.may_move = true;
  moving.covariance.diagonal().array() += 0.01;
  moving.state[3] = 2;
  team.uavs[0].member->Share({moving}, Time());
  team.Run(2);
  TeamFusion fusion({}, {});
  const TeamView view = ViewTeam(*team.uavs[1].member, team.LocalTime(1), &fusion);
  ASSERT_THAT(view.objects, SizeIs(1));
  EXPECT_GT(view.objects[0].position().x(), 2);
  EXPECT_LT(view.objects[0].position().x(), 4);
}

struct Hunters : FieldTeam {
  explicit Hunters(std::uint64_t seed) : FieldTeam(5, 0, seed), holds(5) {}

  // All UAVs choose, four times a second.
  void Hunt(double seconds) {
    for (double t = 0; t < seconds; t += 0.25) {
      for (std::size_t i = 0; i < 5; ++i) {
        if (team.uavs[i].member == nullptr) continue;
        const TeamView view = View(i);
        const auto chosen =
            ChooseObject(view, Eigen::Vector3d(spacing_m * i, 50, 0), DefaultObjectModel(),
                         team.LocalTime(i), team.uavs[i].member.get());
        holds[i] = chosen ? std::optional<Eigen::Vector3d>(view.objects[*chosen].position())
                          : std::nullopt;
      }
      team.Run(0.25);
    }
  }

  // Returns the number of UAVs that claim an object that another claims, too.
  int Rivals() const {
    int rivals = 0;
    for (std::size_t i = 0; i < 5; ++i) {
      for (std::size_t k = i + 1; k < 5; ++k) {
        rivals += holds[i] && holds[k] && (*holds[i] - *holds[k]).norm() < 1;
      }
    }
    return rivals;
  }

  std::vector<std::optional<Eigen::Vector3d>> holds;
  double spacing_m = 20;  // between neighbouring UAVs
};

TEST(ChooseObject, EachUavChoosesAnotherObject) {
  Hunters hunters(1);
  hunters.Hunt(1);
  EXPECT_EQ(hunters.Rivals(), 0);
  ASSERT_THAT(hunters.holds, Each(Ne(std::nullopt)));
  const auto before = hunters.holds;
  hunters.Hunt(1);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_LT((*before[i] - *hunters.holds[i]).norm(), 0.1);
}

TEST(ChooseObject, AllUavsKnowWhoClaimsWhichObject) {
  Hunters hunters(1);
  hunters.Hunt(2);
  for (std::size_t i = 0; i < 5; ++i) {
    std::vector<std::string> holders;
    for (const TeamObject& known : OwnMap(hunters.View(i))) {
      if (!known.holder.empty()) holders.push_back(known.holder);
    }
    EXPECT_THAT(holders, UnorderedElementsAre("a", "b", "c", "d", "e"));
  }
}

TEST(ChooseObject, RivalsAgreeAfterPartition) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Hunters hunters(seed);
    hunters.spacing_m = 1;  // all want the same object
    hunters.team.is_cut = [](std::size_t from, std::size_t to) { return (from < 2) != (to < 2); };
    hunters.Hunt(8);
    EXPECT_GT(hunters.Rivals(), 0) << seed;
    hunters.team.is_cut = [](auto, auto) { return false; };
    hunters.Hunt(1);
    EXPECT_EQ(hunters.Rivals(), 0) << seed;
  }
}

TEST(ChooseObject, ClaimOfSilentUavExpires) {
  Hunters hunters(4);
  hunters.Hunt(1);
  const auto claim = hunters.team.uavs[0].member->ClaimOf({"a", 1}, hunters.team.now);
  ASSERT_TRUE(claim);
  hunters.team.uavs[0].member.reset();
  const auto holder = [&] {
    const TeamView view = hunters.View(1);
    return view.holders[view.index.at(claim->object)];
  };
  hunters.team.Run(2);
  EXPECT_EQ(holder(), (UavKey{"a", 1}));
  hunters.team.Run(4);
  EXPECT_NE(holder(), (UavKey{"a", 1}));
}

}  // namespace
}  // namespace kestrel
