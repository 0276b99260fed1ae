// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/vehicle/multicopter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/vehicle/wind.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr double kStep_s = 0.005;

double Tilt(const Multicopter& multicopter) {
  const Vector3d up = multicopter.world_from_body().rotation * Vector3d::UnitZ();
  return std::acos(std::min(1.0, up.z()));
}

TEST(MulticopterTest, ReachesVelocityInAnyWind) {
  for (const Vector3d& wind : {Vector3d(0, 0, 0), Vector3d(5, -3, 0.5)}) {
    Multicopter multicopter({}, {0, 0, 10}, 0);
    for (int i = 0; i < 1000; ++i) multicopter.Step({{4, 1, -1}, {0, 0, 0}}, wind, kStep_s);
    EXPECT_LT((multicopter.velocity() - Vector3d(4, 1, -1)).norm(), 0.01);
  }
}

TEST(MulticopterTest, KeepsItsLimits) {
  const MulticopterOptions options;
  Multicopter multicopter(options, {0, 0, 10}, 0);
  double tilt = 0;
  double acceleration = 0;
  double speed = 0;
  double sink = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d before = multicopter.velocity();
    const double along = i < 1000 ? 99 : -99;
    multicopter.Step({{along, 0, -99}, {99, 0, 0}}, {0, 0, 0}, kStep_s);
    const Vector3d change = (multicopter.velocity() - before) / kStep_s;
    tilt = std::max(tilt, Tilt(multicopter));
    acceleration = std::max(acceleration, change.head<2>().norm());
    speed = std::max(speed, multicopter.velocity().head<2>().norm());
    sink = std::max(sink, -multicopter.velocity().z());
  }
  EXPECT_LE(tilt, options.max_tilt_deg * std::numbers::pi / 180 + 1e-9);
  EXPECT_GT(tilt, 0.5);
  EXPECT_LE(acceleration, 1.2 * options.max_acceleration) << "the air brakes as well";
  EXPECT_NEAR(speed, options.max_speed_mps, 1);
  EXPECT_NEAR(sink, options.max_climb_mps, 0.5);
}

TEST(MulticopterTest, TiltsWithLag) {
  const MulticopterOptions options;
  Multicopter multicopter(options, {0, 0, 10}, 0);
  multicopter.Step({{0, 0, 0}, {3, 0, 0}}, {0, 0, 0}, kStep_s);
  EXPECT_LT(Tilt(multicopter), 0.01);
  for (int i = 0; i < 20; ++i) multicopter.Step({{0, 0, 0}, {3, 0, 0}}, {0, 0, 0}, kStep_s);
  EXPECT_GT(Tilt(multicopter), 0.1);
}

TEST(WindTest, HasRequestedSpeedAndGusts) {
  for (int seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    const WindOptions options{.min_mps = 4, .max_mps = 5, .gusts = 0.2};
    const Path wind = MakeWind(options, &random);
    Vector3d mean(0, 0, 0);
    Vector3d squares(0, 0, 0);
    constexpr int kCount = 10000;
    for (int i = 0; i < kCount; ++i) {
      mean += wind(0.1 * i) / kCount;
      squares += wind(0.1 * i).cwiseAbs2() / kCount;
    }
    EXPECT_GT(mean.norm(), 3.9);
    EXPECT_LT(mean.norm(), 5.1);
    const Vector3d gusts = (squares - mean.cwiseAbs2()).cwiseSqrt() / mean.norm();
    EXPECT_NEAR(gusts.x(), 0.2, 0.02);
    EXPECT_NEAR(gusts.y(), 0.2, 0.02);
    EXPECT_NEAR(gusts.z(), 0.1, 0.01);
  }
}

}  // namespace
}  // namespace kestrel
