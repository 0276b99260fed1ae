// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/ring_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/landing/test_prints.h"

namespace kestrel {
namespace {

constexpr double kTolerance = 0.01;  // rad

// Rays to the outline of radius(t), in the plane of a pose.
template <class Radius>
std::vector<Eigen::Vector3d> Outline(const RigidTransform& pose, const Radius& radius) {
  std::vector<Eigen::Vector3d> rays;
  for (int i = 0; i < 48; ++i) {
    const double t = 2 * std::numbers::pi * (i + 0.5) / 48;
    rays.push_back(
        (pose * (radius(t) * Eigen::Vector3d(std::cos(t), std::sin(t), 0))).normalized());
  }
  return rays;
}

double Square(double t) { return 0.45 / std::max(std::abs(std::cos(t)), std::abs(std::sin(t))); }

TEST(FitRing, FindsPosesOfACircle) {
  Random random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const RigidTransform pose =
        PrintPose({random.Uniform(-3, 3), random.Uniform(-3, 3), random.Uniform(1, 5)},
                  random.Uniform(0.1, 0.8), random.Uniform(0, 6), 0);
    const Eigen::Vector3d normal = pose.rotation * Eigen::Vector3d::UnitZ();
    if (normal.dot(pose.translation.normalized()) > -0.2) continue;
    const auto ring = FitRing(Outline(pose, [](double) { return 0.5; }), 0.5, kTolerance);
    ASSERT_TRUE(ring);
    const auto error = [&](const CirclePose& found) {
      return (found.center - pose.translation).norm() + (found.normal - normal).norm();
    };
    EXPECT_LT(std::min(error(ring->poses[0]), error(ring->poses[1])), 1e-3);
  }
}

TEST(FitRing, AsksFor95PercentWithinTheTolerance) {
  const RigidTransform pose = PrintPose({0.3, 0.2, 2}, 0.5, 1, 0);
  const auto with_outliers = [&](int count, double offset) {
    auto rays = Outline(pose, [](double) { return 0.5; });
    for (int i = 0; i < count; ++i) {
      Eigen::Vector3d& ray = rays[i * 48 / count];
      ray = (ray + offset * (ray - pose.translation.normalized()).normalized()).normalized();
    }
    return rays;
  };
  EXPECT_TRUE(FitRing(with_outliers(2, 2 * kTolerance), 0.5, kTolerance));  // 4 %
  EXPECT_FALSE(FitRing(with_outliers(6, 3 * kTolerance), 0.5, kTolerance));
  EXPECT_TRUE(FitRing(with_outliers(6, 0.5 * kTolerance), 0.5, kTolerance));
}

TEST(FitRing, RefusesOtherFigures) {
  const RigidTransform pose = PrintPose({0.3, 0.2, 2}, 0.5, 1, 0);
  EXPECT_FALSE(FitRing(Outline(pose, Square), 0.5, kTolerance));
  const auto star = [](double t) { return 0.5 + 0.05 * std::cos(5 * t); };
  EXPECT_FALSE(FitRing(Outline(pose, star), 0.5, kTolerance));
  EXPECT_FALSE(FitRing({}, 0.5, kTolerance));
}

TEST(FitRing, TestsNearAndFarSideAlike) {
  // Seen obliquely from close by, the same angle is moved on the near and on the far side: both
  // must be found out.
  const RigidTransform pose = PrintPose({0, 0.2, 0.9}, 1.0, 0, 0);
  for (const int first : {8, 32}) {
    auto rays = Outline(pose, [](double) { return 0.5; });
    for (int i = first; i < first + 6; ++i) {
      rays[i] =
          (rays[i] + 0.05 * (rays[i] - pose.translation.normalized()).normalized()).normalized();
    }
    EXPECT_FALSE(FitRing(rays, 0.5, kTolerance)) << first;
  }
}

}  // namespace
}  // namespace kestrel
