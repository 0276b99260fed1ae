// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/candidates/ring_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

constexpr double kTolerance = 0.01;  // rad

// Rays to the outline radius(t) (m), in the plane of a pose.
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

// Moves 'count' neighbouring rays, from 'first' on, away from the middle of the ring.
std::vector<Eigen::Vector3d> WithBulge(std::vector<Eigen::Vector3d> rays,
                                       const RigidTransform& pose, int first, int count,
                                       double offset) {
  for (int i = first; i < first + count; ++i) {
    Eigen::Vector3d& ray = rays[i % rays.size()];
    ray = (ray + offset * (ray - pose.translation.normalized()).normalized()).normalized();
  }
  return rays;
}

std::optional<RingFit> Fit(std::vector<Eigen::Vector3d> rays) {
  return FitRing(rays, 0.5, kTolerance);
}

// Error of the better of the two poses, m.
double PoseError(const RingFit& ring, const RigidTransform& pose) {
  const Eigen::Vector3d normal = pose.rotation * Eigen::Vector3d::UnitZ();
  const auto error = [&](const CirclePose& found) {
    return (found.center - pose.translation).norm() + (found.normal - normal).norm();
  };
  return std::min(error(ring.poses[0]), error(ring.poses[1]));
}

std::vector<Eigen::Vector3d> Circle(const RigidTransform& pose) {
  return Outline(pose, [](double) { return 0.5; });
}

TEST(FitRing, FindsPosesOfCircle) {
  Random random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const RigidTransform pose =
        PrintPose({random.Uniform(-3, 3), random.Uniform(-3, 3), random.Uniform(1, 5)},
                  random.Uniform(0.1, 0.8), random.Uniform(0, 6), 0);
    const Eigen::Vector3d normal = pose.rotation * Eigen::Vector3d::UnitZ();
    if (normal.dot(pose.translation.normalized()) > -0.2) continue;
    const auto ring = Fit(Circle(pose));
    ASSERT_TRUE(ring);
    EXPECT_LT(PoseError(*ring, pose), 1e-3);
  }
}

TEST(FitRing, IgnoresDirtBesideRing) {
  // Seen obliquely from close by: dirt on the near and on the far side alike.
  const RigidTransform pose = PrintPose({0, 0.2, 0.9}, 1.0, 0, 0);
  for (int first = 0; first < 48; first += 4) {
    const auto ring = Fit(WithBulge(Circle(pose), pose, first, 8, 5 * kTolerance));
    ASSERT_TRUE(ring) << first;
    EXPECT_LT(PoseError(*ring, pose), 1e-3) << first;
  }
}

TEST(FitRing, RequiresMostPointsWithinTolerance) {
  const RigidTransform pose = PrintPose({0.3, 0.2, 2}, 0.5, 1, 0);
  const auto with_every_third = [&](double offset) {
    auto rays = Circle(pose);
    for (int i = 0; i < 48; i += 3) rays = WithBulge(rays, pose, i, 1, offset);
    return rays;
  };
  EXPECT_TRUE(Fit(with_every_third(0.5 * kTolerance)));
  EXPECT_FALSE(Fit(with_every_third(5 * kTolerance)));
}

TEST(FitRing, RefusesOtherFigures) {
  const RigidTransform pose = PrintPose({0.3, 0.2, 2}, 0.5, 1, 0);
  EXPECT_FALSE(Fit(Outline(pose, Square)));
  EXPECT_FALSE(Fit(Outline(pose, [](double t) { return 0.5 + 0.08 * std::cos(5 * t); })));
  EXPECT_FALSE(Fit({}));
}

}  // namespace
}  // namespace kestrel
