// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/sought_object.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/vision/mapping/test_map.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr std::size_t kRedDisc = 0, kYellowDisc = 3;  // in the model's classes
constexpr double kFrame_s = 0.1;

// A map and the sought object, which get the same discs.
struct Search {
  explicit Search(const std::string& name) : sought(model, name, {}) {}

  struct Disc {
    Vector3d position;
    std::size_t color, class_index;
  };
  void See(const std::vector<Disc>& discs) {
    time_s += kFrame_s;
    std::vector<ObjectMeasurement> measurements;
    std::vector<ObjectSighting> sightings;
    for (const Disc& disc : discs) {
      measurements.push_back(MeasureNoisily(disc.position, disc.color, 0.02, &random));
      sightings.push_back({At(time_s), disc.class_index, measurements.back().position,
                           measurements.back().covariance});
    }
    map.Update(At(time_s), measurements, SeesAll());
    sought.Update(At(time_s), sightings, map);
  }
  void See(const std::vector<Disc>& discs, int frames) {
    for (int i = 0; i < frames; ++i) See(discs);
  }
  Vector3d Place() const { return sought.At(At(time_s))->motion.position(); }

  ObjectModel model = DefaultObjectModel();
  ObjectMap map{model, {}};
  Random random{1};
  double time_s = 0;
  SoughtObject sought;
};

Search::Disc Red(const Vector3d& position) { return {position, kRed, kRedDisc}; }
Search::Disc Yellow(const Vector3d& position) { return {position, kYellow, kYellowDisc}; }

TEST(SoughtObjectTest, FindsObjectOfItsClassInConfirmedMap) {
  Search search("yellow");
  search.See({Red({0, 0, 0}), Yellow({5, 2, 0})});
  EXPECT_EQ(search.sought.number(), 0);
  search.See({Red({0, 0, 0}), Yellow({5, 2, 0})}, 12);
  ASSERT_NE(search.sought.number(), 0);
  EXPECT_LT((search.Place() - Vector3d(5, 2, 0)).norm(), 0.05);
  EXPECT_EQ(search.sought.StateAt(At(search.time_s)), TrackState::kTracking);
}

TEST(SoughtObjectTest, StaysTheSameWhenOthersAreNear) {
  Search search("red");
  search.See({Red({0, 0, 0})}, 12);
  const int number = search.sought.number();
  search.See({Red({0.8, 0, 0}), Red({0, 0, 0})}, 20);
  EXPECT_EQ(search.sought.number(), number);
  EXPECT_LT(search.Place().norm(), 0.05);
}

TEST(SoughtObjectTest, FollowsWhatMoves) {
  Search search("yellow");
  for (int i = 0; i < 80; ++i) search.See({Yellow({1.4 * kFrame_s * i, 0, 0.14})});
  const TurnState motion = search.sought.At(At(search.time_s))->motion;
  EXPECT_NEAR(motion.position().x(), 1.4 * kFrame_s * 79, 0.05);
  EXPECT_NEAR(motion.velocity().x(), 1.4, 0.15);
}

TEST(SoughtObjectTest, AnotherOneIsSoughtWhenItIsGone) {
  Search search("red");
  search.See({Red({0, 0, 0})}, 12);
  const int number = search.sought.number();
  const auto seen = search.sought.seen();
  search.See({Red({4, 0, 0})}, 10);
  EXPECT_EQ(search.sought.number(), number);  // it may only be hidden
  EXPECT_EQ(search.sought.seen(), seen);
  search.See({Red({4, 0, 0})}, 40);
  EXPECT_NE(search.sought.number(), number);
  EXPECT_LT((search.Place() - Vector3d(4, 0, 0)).norm(), 0.05);
}

TEST(SoughtObjectTest, UnknownClassIsRefused) {
  EXPECT_THAT([] { Search("purple"); },
              ThrowsMessage<InputError>(
                  HasSubstr("no class 'purple', expected red, green, blue, yellow, orange")));
}

TEST(SoughtObjectTest, AssignedObjectIsWhereOthersHaveSeenItUntilItIsSeen) {
  Search search("red");
  search.See({Red({0, 0, 0})}, 12);
  AssignedObject assigned;
  assigned.number = 4;
  assigned.object = search.map.Confirmed().front();
  assigned.object.state.head<3>() = Vector3d(6, 0, 0);
  search.sought.Assign(assigned);
  search.See({Red({0, 0, 0})});
  EXPECT_EQ(search.sought.number(), 4);
  EXPECT_LT((search.Place() - Vector3d(6, 0, 0)).norm(), 0.01);
  search.See({Red({0, 0, 0}), Red({6.2, 0, 0})}, 12);
  EXPECT_LT((search.Place() - Vector3d(6.2, 0, 0)).norm(), 0.05);
  search.sought.Assign({});
  search.See({Red({0, 0, 0}), Red({6.2, 0, 0})});
  EXPECT_EQ(search.sought.number(), 0);
}

TEST(SoughtObjectTest, ObjectThatIsLeftIsNotSoughtAgain) {
  Search search("red");
  search.See({Red({0, 0, 0})}, 12);
  search.sought.Leave(search.sought.number());
  search.See({Red({0, 0, 0})}, 12);
  EXPECT_EQ(search.sought.number(), 0);
  search.See({Red({0, 0, 0}), Red({5, 0, 0})}, 12);
  EXPECT_LT((search.Place() - Vector3d(5, 0, 0)).norm(), 0.05);
}

}  // namespace
}  // namespace kestrel
