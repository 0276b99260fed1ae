// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/world_alignment.h"

#include <Eigen/Cholesky>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/team/test_team.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

const WorldPrior kPrior{1.5, Radians(2)};

// Returns the field as seen by a UAV whose navigation is off.
std::vector<MappedObject> SeenIn(const WorldAlignment& world, std::vector<MappedObject> objects,
                                 double sigma_m, Random* random) {
  for (MappedObject& object : objects) {
    const Eigen::Vector3d noise{random->Normal(), random->Normal(), random->Normal()};
    object.state.head<3>() = world * object.position() + sigma_m * noise;
  }
  return objects;
}

TEST(EstimateAlignment, FindsBiasWithCovariance) {
  double squares = 0;
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    const std::vector<MappedObject> field = TestField(60, &random);
    WorldAlignment bias;
    bias.pivot = {50, 50, 0};
    bias.translation = {random.Normal(), random.Normal(), 0.3 * random.Normal()};
    bias.yaw = Radians(2) * random.Uniform(-1, 1);
    // Each sees two thirds of the field.
    const std::vector<MappedObject> first(field.begin(), field.begin() + 40);
    const auto second = SeenIn(bias, {field.begin() + 20, field.end()}, 0.05, &random);
    const auto estimate = EstimateAlignment(second, SeenIn({}, first, 0.05, &random), kPrior);
    ASSERT_TRUE(estimate) << seed;
    EXPECT_GE(estimate->matches, 10u) << seed;
    const WorldAlignment& alignment = estimate->alignment;
    ++found;
    for (std::size_t i = 0; i < second.size(); ++i) {
      const Eigen::Vector3d error = alignment * second[i].position() - field[20 + i].position();
      EXPECT_LT(error.norm(), 0.4) << seed;
    }
    const Eigen::Vector3d at_pivot = alignment * alignment.pivot - bias.Inverse() * alignment.pivot;
    squares += at_pivot.dot(alignment.covariance.topLeftCorner<3, 3>().llt().solve(at_pivot));
  }
  EXPECT_LT(squares / (3 * found), 1.5);  // 1 when the covariance agrees with the errors
}

TEST(EstimateAlignment, RejectsTooFewMatches) {
  Random random(3);
  const std::vector<MappedObject> field = TestField(60, &random);
  const std::vector<MappedObject> two(field.begin(), field.begin() + 2);
  EXPECT_FALSE(EstimateAlignment(two, field, kPrior));
  EXPECT_FALSE(EstimateAlignment({}, field, kPrior));
  // Other objects, which match by chance at most.
  Random other(4);
  EXPECT_FALSE(EstimateAlignment(TestField(60, &other), field, kPrior));
}

// A row of equal objects looks the same when shifted by one.
TEST(EstimateAlignment, RejectsAmbiguousMatches) {
  std::vector<MappedObject> row;
  for (int i = 0; i < 5; ++i) row.push_back(TestDisc(5 * (i + 1), {3.5 * i, 0, 0}, Time()));
  const std::vector<MappedObject> first(row.begin(), row.begin() + 4);
  EXPECT_FALSE(EstimateAlignment(first, {row.begin() + 1, row.end()}, {3, Radians(2)}));
}

TEST(WorldAlignment, InverseAndProductCompose) {
  WorldAlignment there;
  there.pivot = {1, 2, 3};
  there.translation = {4, 5, 6};
  there.yaw = 0.3;
  const Eigen::Vector3d point(7, 8, 9);
  EXPECT_LT((there.Inverse() * (there * point) - point).norm(), 1e-12);
  WorldAlignment on;
  on.pivot = {-3, 1, 0};
  on.translation = {1, 0, -2};
  on.yaw = -0.7;
  EXPECT_LT(((on * there) * point - on * (there * point)).norm(), 1e-12);
  MappedObject object = TestDisc(1, point, Time());
  MoveToWorld(there, &object);
  EXPECT_LT((object.position() - there * point).norm(), 1e-12);
}

}  // namespace
}  // namespace kestrel
