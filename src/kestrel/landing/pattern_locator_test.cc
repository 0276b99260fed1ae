// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/pattern_locator.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/landing/test_prints.h"

namespace kestrel {
namespace {

class PatternLocatorTest : public ::testing::Test {
 protected:
  cv::Mat Draw(const RigidTransform& pose) const {
    return DrawPrint(camera_, pattern_, SpokedPrint(pattern_, 4), pose);
  }
  Eigen::Vector2d Center(const RigidTransform& pose) const {
    Eigen::Vector2d pixel(-1e9, -1e9);
    camera_.Project(pose.translation, &pixel);
    return pixel;
  }
  // A pose some pixels away.
  RigidTransform Disturb(const RigidTransform& pose, Random* random) const {
    RigidTransform disturbed = pose;
    for (int k = 0; k < 3; ++k) disturbed.translation(k) += 0.01 * random->Uniform(-1, 1);
    const Eigen::Vector3d turn{random->Normal(), random->Normal(), random->Normal()};
    disturbed.rotation = Eigen::AngleAxisd(0.03, turn.normalized()) * disturbed.rotation;
    return disturbed;
  }

  const LandingPattern pattern_{};
  const CameraModel camera_ = TestPrintCamera();
  const PatternLocator locator_{camera_, pattern_};
};

TEST_F(PatternLocatorTest, RecoversThePose) {
  Random random(1);
  for (int trial = 0; trial < 12; ++trial) {
    const double distance = random.Uniform(1.3, 3);
    const RigidTransform truth =
        PrintPose({random.Uniform(-0.15, 0.15), random.Uniform(-0.1, 0.1), distance},
                  random.Uniform(0, 0.5), random.Uniform(0, 6), random.Uniform(0, 6));
    const cv::Mat image = Draw(truth);
    const auto location = locator_.Locate(image, Disturb(truth, &random), 5, 10, 6);
    ASSERT_TRUE(location);
    EXPECT_LT((Center(location->camera_from_pattern) - Center(truth)).norm(), 0.05) << trial;
    const auto error = PoseError(location->camera_from_pattern, truth);
    EXPECT_LT(error.head<3>().norm(), 0.003 * distance) << trial;
    EXPECT_LT(error.tail<3>().norm(), 0.03) << trial;
    EXPECT_LT(location->edge_rms_px, 0.2);
    EXPECT_GT(location->edge_share, 0.9);
    for (int k = 0; k < 4; ++k) {
      EXPECT_GT(location->arm_share[k], 0.8);
      EXPECT_GT(location->ring_share[k], 0.8);
    }
  }
}

// White that the image cuts off spreads over the black: here by half a pixel and more.
TEST_F(PatternLocatorTest, OverexposureDoesNotMoveIt) {
  Random random(5);
  for (int trial = 0; trial < 12; ++trial) {
    const double distance = random.Uniform(1.3, 3);
    const RigidTransform truth = PrintPose({0.1, -0.05, distance}, random.Uniform(0.1, 0.5),
                                           random.Uniform(0, 6), random.Uniform(0, 6));
    cv::Mat image = Draw(truth);
    cv::GaussianBlur(image, image, {}, 0.7);
    image.convertTo(image, CV_8UC1, 2.2, 0);
    const auto location = locator_.Locate(image, Disturb(truth, &random), 5, 10, 6);
    ASSERT_TRUE(location);
    const auto error = PoseError(location->camera_from_pattern, truth);
    EXPECT_LT(error.head<3>().norm(), 0.003 * distance) << trial;
    EXPECT_LT(error.tail<3>().norm(), 0.03) << trial;
    EXPECT_LT(location->edge_rms_px, 0.25) << trial;
  }
}

TEST_F(PatternLocatorTest, TheCovarianceIsThatOfTheErrors) {
  Random random(2);
  for (const double distance : {1.2, 1.8, 3.5}) {
    const RigidTransform truth = PrintPose({0.1, -0.05, distance}, 0.35, 0.8, 0.4);
    const cv::Mat image = Draw(truth);
    constexpr int kTrials = 60;
    double sum = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto location =
          locator_.Locate(AddNoise(image, 8, &random), Disturb(truth, &random), 4, 30, 3);
      ASSERT_TRUE(location);
      const auto error = PoseError(location->camera_from_pattern, truth);
      sum += error.dot(location->covariance.ldlt().solve(error)) / 6;
    }
    const double ratio = std::sqrt(sum / kTrials);  // of errors and standard deviations
    EXPECT_GT(ratio, 0.85) << distance;
    EXPECT_LT(ratio, 1.2) << distance;
  }
}

// The tilt moves the outlines of a print that is seen from straight above by its square only.
TEST_F(PatternLocatorTest, FromStraightAboveItSettles) {
  for (const double distance : {3.0, 4.0}) {
    const RigidTransform truth = PrintPose({0.1, 0.2, distance}, 0.02, 0.5, 0.4);
    const RigidTransform tilted = PrintPose({0.1, 0.2, 1.02 * distance}, 0.35, 0.5, 0.4);
    const auto location = locator_.Locate(Draw(truth), tilted, 3, 10, 3);
    ASSERT_TRUE(location);
    const Eigen::Vector3d error = location->camera_from_pattern.translation - truth.translation;
    EXPECT_LT(error.norm(), 0.0008 * distance);
  }
}

TEST_F(PatternLocatorTest, WhatIsKnownOfThePlaneSteadiesTheTilt) {
  Random random(4);
  const RigidTransform truth = PrintPose({0.3, 0.2, 7}, 0.03, 0.8, 0.4);
  const cv::Mat image = Draw(truth);
  const NormalPrior level{truth.rotation * Eigen::Vector3d::UnitZ(), 0.02};
  double without = 0;
  double with = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const cv::Mat noisy = AddNoise(image, 8, &random);
    const RigidTransform start = Disturb(truth, &random);
    const auto free = locator_.Locate(noisy, start, 3, 10, 3);
    const auto steady = locator_.Locate(noisy, start, 3, 10, 3, level);
    ASSERT_TRUE(free && steady);
    without += PoseError(free->camera_from_pattern, truth).tail<3>().squaredNorm();
    with += PoseError(steady->camera_from_pattern, truth).tail<3>().squaredNorm();
  }
  EXPECT_LT(2 * with, without);
}

TEST_F(PatternLocatorTest, APartOutOfViewSaysNothing) {
  Random random(3);
  const RigidTransform truth = PrintPose({1.05, 0, 1.6}, 0, 0, 0);
  const auto location = locator_.Locate(Draw(truth), Disturb(truth, &random), 5, 10, 6);
  ASSERT_TRUE(location);
  EXPECT_LT((Center(location->camera_from_pattern) - Center(truth)).norm(), 0.2);
  EXPECT_LT(location->arm_share[0], 0);
  EXPECT_GT(location->arm_share[2], 0.8);
}

TEST_F(PatternLocatorTest, WithoutEdgesThereIsNoPose) {
  const RigidTransform pose = PrintPose({0, 0, 2}, 0, 0, 0);
  EXPECT_FALSE(locator_.Locate(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)), pose, 5, 10, 4));
  EXPECT_FALSE(locator_.Locate(Draw(pose), PrintPose({0, 0, -2}, 0, 0, 0), 5, 10, 4));
}

TEST_F(PatternLocatorTest, TheRingAloneGivesItsPlaneAndCentre) {
  Random random(7);
  const Print ring = [this](double x, double y) { return IsRing(pattern_, x, y); };
  for (int trial = 0; trial < 8; ++trial) {
    const double distance = random.Uniform(1.3, 3);
    const RigidTransform truth = PrintPose({0.1, -0.05, distance}, random.Uniform(0.2, 0.5),
                                           random.Uniform(0, 6), random.Uniform(0, 6));
    const cv::Mat image = DrawPrint(camera_, pattern_, ring, truth);
    const auto found = locator_.LocateRing(image, Disturb(truth, &random), 5, 10, 6);
    ASSERT_TRUE(found);
    EXPECT_LT((found->translation - truth.translation).norm(), 0.005 * distance) << trial;
    const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
    EXPECT_GT((found->rotation * z).dot(truth.rotation * z), std::cos(0.02)) << trial;
  }
}

TEST_F(PatternLocatorTest, NothingIsLocatedOnAnEvenImage) {
  const cv::Mat even(240, 320, CV_8UC1, cv::Scalar(120));
  EXPECT_FALSE(locator_.LocateRing(even, PrintPose({0, 0, 2}, 0.2, 0, 0), 5, 10, 4));
}

}  // namespace
}  // namespace kestrel
