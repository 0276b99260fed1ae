// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/geometry/cone.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

std::vector<Eigen::Vector3d> RaysOfCircle(const CirclePose& circle, double radius, int count) {
  const Eigen::Vector3d x = circle.normal.unitOrthogonal();
  const Eigen::Vector3d y = circle.normal.cross(x);
  std::vector<Eigen::Vector3d> rays;
  for (int i = 0; i < count; ++i) {
    const double t = 2 * std::numbers::pi * i / count;
    rays.push_back((circle.center + radius * (std::cos(t) * x + std::sin(t) * y)).normalized());
  }
  return rays;
}

Eigen::Vector3d RandomDirection(Random* random) {
  return Eigen::Vector3d{random->Normal(), random->Normal(), random->Normal()}.normalized();
}

// A circle of radius 1 in any direction, its normal up to 'max_tilt' (rad) from the line of sight.
CirclePose RandomCircle(double max_tilt, Random* random) {
  const Eigen::Vector3d sight = RandomDirection(random);
  const double tilt = random->Uniform(0, max_tilt);
  const Eigen::Vector3d axis = sight.cross(RandomDirection(random)).normalized();
  CirclePose circle;
  circle.center = random->Uniform(2, 40) * sight;
  circle.normal = Eigen::AngleAxisd(tilt, axis) * -sight;
  return circle;
}

Eigen::Vector3d Sum(const std::vector<Eigen::Vector3d>& rays) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& ray : rays) sum += ray;
  return sum;
}

double LargestValueOn(const Cone& cone, const std::vector<Eigen::Vector3d>& rays) {
  double largest = 0;
  for (const Eigen::Vector3d& ray : rays) {
    largest = std::max(largest, std::abs(ray.dot(cone.matrix * ray)));
  }
  return largest;
}

TEST(FitCone, RecoversRandomCirclesInAllDirections) {
  Random random(1);
  for (int trial = 0; trial < 500; ++trial) {
    const CirclePose truth = RandomCircle(75 * kDegree, &random);
    const auto rays = RaysOfCircle(truth, 1, random.Integer(6, 60));
    const auto cone = FitCone(rays);
    ASSERT_TRUE(cone) << "trial " << trial;
    EXPECT_LT(LargestValueOn(*cone, rays), 1e-9);
    const auto poses = CirclePosesFromCone(*cone, 1, Sum(rays));
    const auto error = [&](const CirclePose& pose) {
      return (pose.center - truth.center).norm() / truth.center.norm() +
             (pose.normal - truth.normal).norm();
    };
    // Near the line of sight the error of the normal is the square root of the cone's error.
    EXPECT_LT(std::min(error(poses[0]), error(poses[1])), 2e-4) << "trial " << trial;
  }
}

TEST(FitCone, BothMirrorPosesHaveSameImage) {
  Random random(2);
  for (int trial = 0; trial < 200; ++trial) {
    const CirclePose truth = RandomCircle(75 * kDegree, &random);
    const auto rays = RaysOfCircle(truth, 1, 24);
    const auto cone = FitCone(rays);
    ASSERT_TRUE(cone);
    for (const CirclePose& pose : CirclePosesFromCone(*cone, 1, Sum(rays))) {
      EXPECT_LT(LargestValueOn(*cone, RaysOfCircle(pose, 1, 24)), 1e-9);
      EXPECT_NEAR(pose.normal.norm(), 1, 1e-12);
      EXPECT_LT(pose.normal.dot(pose.center), 0) << "the normal points to the apex";
      EXPECT_GT(pose.center.dot(truth.center), 0) << "the circle lies in front";
    }
  }
}

TEST(FitCone, TakesConesOfUpTo80Degrees) {
  for (const double half_angle : {1.0, 20.0, 45.0, 70.0, 80.0}) {
    CirclePose truth;
    truth.center = Eigen::Vector3d(0.3, -0.5, 1).normalized();
    truth.normal = -truth.center;
    const double radius = std::tan(half_angle * kDegree);
    const auto rays = RaysOfCircle(truth, radius, 32);
    const auto cone = FitCone(rays);
    ASSERT_TRUE(cone) << half_angle;
    EXPECT_NEAR(cone->HalfAngles().x(), half_angle * kDegree, 1e-9);
    EXPECT_NEAR(cone->HalfAngles().y(), half_angle * kDegree, 1e-9);
    for (const CirclePose& pose : CirclePosesFromCone(*cone, radius, Sum(rays))) {
      EXPECT_LT((pose.center - truth.center).norm(), 1e-6) << half_angle;
    }
  }
}

TEST(FitCone, AveragesNoise) {
  Random random(3);
  CirclePose truth;
  truth.center = Eigen::Vector3d(1, 2, 8);
  truth.normal = Eigen::Vector3d(0.2, -0.3, -1).normalized();
  constexpr double kSigma = 1e-3;  // rad
  constexpr int kRays = 48, kTrials = 100;
  double squares = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    auto rays = RaysOfCircle(truth, 1, kRays);
    for (Eigen::Vector3d& ray : rays) {
      for (int k = 0; k < 3; ++k) ray(k) += kSigma * random.Normal();
      ray.normalize();
    }
    const auto cone = FitCone(rays);
    ASSERT_TRUE(cone);
    const auto poses = CirclePosesFromCone(*cone, 1, Sum(rays));
    squares += std::min((poses[0].center.normalized() - truth.center.normalized()).squaredNorm(),
                        (poses[1].center.normalized() - truth.center.normalized()).squaredNorm());
  }
  // Each axis of a circle's centre is known to sigma * sqrt(2 / n).
  EXPECT_LT(std::sqrt(squares / kTrials), 1.5 * kSigma * std::sqrt(4.0 / kRays));
}

TEST(FitCone, RefusesRaysWithoutEllipse) {
  CirclePose circle;
  circle.center = Eigen::Vector3d(0, 0, 4);
  circle.normal = Eigen::Vector3d(0, 0, -1);
  EXPECT_FALSE(FitCone({}));
  EXPECT_FALSE(FitCone(RaysOfCircle(circle, 1, 5)));
  EXPECT_FALSE(FitCone(std::vector<Eigen::Vector3d>(20, Eigen::Vector3d::UnitZ())));

  std::vector<Eigen::Vector3d> straight;  // in a plane through the apex
  for (int i = 0; i < 20; ++i) straight.push_back(Eigen::Vector3d(0.05 * i, 0.02 * i, 1));
  for (Eigen::Vector3d& ray : straight) ray.normalize();
  EXPECT_FALSE(FitCone(straight));

  std::vector<Eigen::Vector3d> around;  // the whole horizon: the rays cancel
  for (int i = 0; i < 20; ++i) {
    around.emplace_back(std::cos(0.1 * i * std::numbers::pi), std::sin(0.1 * i * std::numbers::pi),
                        0);
  }
  EXPECT_FALSE(FitCone(around));
  around.assign(19, Eigen::Vector3d::UnitZ());
  around.push_back(-Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(FitCone(around)) << "a ray behind the tangent plane";

  auto broken = RaysOfCircle(circle, 1, 12);
  broken[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(FitCone(broken));
}

TEST(Cone, HalfAnglesAreWidestAndNarrowest) {
  Cone cone;
  const double wide = 0.7, narrow = 0.2;
  cone.matrix =
      Eigen::Vector3d(1 / std::pow(std::tan(narrow), 2), 1 / std::pow(std::tan(wide), 2), -1)
          .asDiagonal();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  cone.matrix = turn * cone.matrix * turn.transpose();
  EXPECT_NEAR(cone.HalfAngles().x(), wide, 1e-12);
  EXPECT_NEAR(cone.HalfAngles().y(), narrow, 1e-12);
}

TEST(CirclePosesFromCone, TowardSelectsAxis) {
  CirclePose truth;
  truth.center = Eigen::Vector3d(1, 0, -3);  // behind the image plane of a fisheye lens
  truth.normal = Eigen::Vector3d(0, 0.3, 1).normalized();
  const auto cone = FitCone(RaysOfCircle(truth, 0.5, 16));
  ASSERT_TRUE(cone);
  const auto there = CirclePosesFromCone(*cone, 0.5, truth.center);
  const auto opposite = CirclePosesFromCone(*cone, 0.5, -truth.center);
  EXPECT_LT(
      std::min((there[0].center - truth.center).norm(), (there[1].center - truth.center).norm()),
      1e-6);
  EXPECT_LT(opposite[0].center.dot(truth.center), 0);
  // The distance is proportional to the radius.
  const auto doubled = CirclePosesFromCone(*cone, 1.0, truth.center);
  EXPECT_LT((doubled[0].center - 2 * there[0].center).norm(), 1e-9);
}

}  // namespace
}  // namespace kestrel
