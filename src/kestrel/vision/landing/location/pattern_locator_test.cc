// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/location/pattern_locator.h"

#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/vision/landing/alignment/print_alignment.h"
#include "kestrel/vision/landing/test_prints.h"

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
  // Finds the edges within 'reach_px' of their prediction by 'start', and locates the print by
  // them.
  std::optional<PatternLocation> Locate(const cv::Mat& image, const RigidTransform& start,
                                        double reach_px, double min_step,
                                        const std::optional<NormalPrior>& prior = {}) const {
    PrintAlignment alignment{PlaneWarp(camera_, start, locator_.outline().radius_m()), {}};
    if (!AlignPrint(image, image, {}, locator_.outline().all(), reach_px, min_step, &alignment)) {
      return std::nullopt;
    }
    return locator_.Locate(alignment.edges, start, prior);
  }
  // Returns a pose some pixels away.
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

TEST_F(PatternLocatorTest, RecoversPose) {
  Random random(1);
  for (int trial = 0; trial < 12; ++trial) {
    const double distance = random.Uniform(1.3, 3);
    const RigidTransform truth =
        PrintPose({random.Uniform(-0.15, 0.15), random.Uniform(-0.1, 0.1), distance},
                  random.Uniform(0, 0.5), random.Uniform(0, 6), random.Uniform(0, 6));
    const cv::Mat image = Draw(truth);
    const auto location = Locate(image, Disturb(truth, &random), 5, 10);
    ASSERT_TRUE(location);
    EXPECT_LT((Center(location->camera_from_target) - Center(truth)).norm(), 0.05) << trial;
    const auto error = PoseError(location->camera_from_target, truth);
    EXPECT_LT(error.head<3>().norm(), 0.003 * distance) << trial;
    EXPECT_LT(error.tail<3>().norm(), 0.03) << trial;
    EXPECT_LT(location->edge_rms_px, 0.2);
  }
}

// White spreads over the black in a saturated image, here by half a pixel and more.
TEST_F(PatternLocatorTest, OverexposureDoesNotMovePose) {
  Random random(5);
  for (int trial = 0; trial < 12; ++trial) {
    const double distance = random.Uniform(1.3, 3);
    const RigidTransform truth = PrintPose({0.1, -0.05, distance}, random.Uniform(0.1, 0.5),
                                           random.Uniform(0, 6), random.Uniform(0, 6));
    cv::Mat image = Draw(truth);
    cv::GaussianBlur(image, image, {}, 0.7);
    image.convertTo(image, CV_8UC1, 2.2, 0);
    const auto location = Locate(image, Disturb(truth, &random), 5, 10);
    ASSERT_TRUE(location);
    const auto error = PoseError(location->camera_from_target, truth);
    EXPECT_LT(error.head<3>().norm(), 0.003 * distance) << trial;
    EXPECT_LT(error.tail<3>().norm(), 0.03) << trial;
    EXPECT_LT(location->edge_rms_px, 0.25) << trial;
  }
}

TEST_F(PatternLocatorTest, CovarianceMatchesErrors) {
  Random random(2);
  for (const double distance : {1.2, 1.8, 3.5}) {
    const RigidTransform truth = PrintPose({0.1, -0.05, distance}, 0.35, 0.8, 0.4);
    const cv::Mat image = Draw(truth);
    constexpr int kTrials = 60;
    double sum = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto location = Locate(AddNoise(image, 8, &random), Disturb(truth, &random), 4, 30);
      ASSERT_TRUE(location);
      const auto error = PoseError(location->camera_from_target, truth);
      sum += error.dot(location->covariance.ldlt().solve(error)) / 6;
    }
    const double ratio = std::sqrt(sum / kTrials);  // ratio of errors to standard deviations
    EXPECT_GT(ratio, 0.85) << distance;
    EXPECT_LT(ratio, 1.2) << distance;
  }
}

// The tilt moves the outlines of a print seen from straight above only by its square.
TEST_F(PatternLocatorTest, ConvergesFromStraightAbove) {
  for (const double distance : {3.0, 4.0}) {
    const RigidTransform truth = PrintPose({0.1, 0.2, distance}, 0.02, 0.5, 0.4);
    const RigidTransform tilted = PrintPose({0.1, 0.2, 1.02 * distance}, 0.35, 0.5, 0.4);
    const auto location = Locate(Draw(truth), tilted, 3, 10);
    ASSERT_TRUE(location);
    const Eigen::Vector3d error = location->camera_from_target.translation - truth.translation;
    EXPECT_LT(error.norm(), 0.0008 * distance);
  }
}

TEST_F(PatternLocatorTest, KnownPlaneStabilisesTilt) {
  Random random(4);
  const RigidTransform truth = PrintPose({0.3, 0.2, 7}, 0.03, 0.8, 0.4);
  const cv::Mat image = Draw(truth);
  const NormalPrior level{truth.rotation * Eigen::Vector3d::UnitZ(), 0.02};
  double without = 0;
  double with = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const cv::Mat noisy = AddNoise(image, 8, &random);
    const RigidTransform start = Disturb(truth, &random);
    const auto free = Locate(noisy, start, 3, 10);
    const auto steady = Locate(noisy, start, 3, 10, level);
    ASSERT_TRUE(free && steady);
    without += PoseError(free->camera_from_target, truth).tail<3>().squaredNorm();
    with += PoseError(steady->camera_from_target, truth).tail<3>().squaredNorm();
  }
  EXPECT_LT(2 * with, without);
}

TEST_F(PatternLocatorTest, IgnoresPartOutOfView) {
  Random random(3);
  const RigidTransform truth = PrintPose({1.05, 0, 1.6}, 0, 0, 0);
  const auto location = Locate(Draw(truth), Disturb(truth, &random), 5, 10);
  ASSERT_TRUE(location);
  EXPECT_LT((Center(location->camera_from_target) - Center(truth)).norm(), 0.2);
}

TEST_F(PatternLocatorTest, FailsWithoutEdges) {
  const RigidTransform pose = PrintPose({0, 0, 2}, 0, 0, 0);
  EXPECT_FALSE(Locate(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)), pose, 5, 10));
  EXPECT_FALSE(Locate(Draw(pose), PrintPose({0, 0, -2}, 0, 0, 0), 5, 10));
}

TEST_F(PatternLocatorTest, RingAloneGivesPlaneAndCentre) {
  Random random(7);
  const Print ring = [this](double x, double y) { return IsRing(pattern_, x, y); };
  for (int trial = 0; trial < 8; ++trial) {
    const double distance = random.Uniform(1.3, 3);
    const RigidTransform truth = PrintPose({0.1, -0.05, distance}, random.Uniform(0.2, 0.5),
                                           random.Uniform(0, 6), random.Uniform(0, 6));
    const cv::Mat image = DrawPrint(camera_, pattern_, ring, truth);
    const auto found = locator_.LocateRing(image, Disturb(truth, &random), 5, 10, 6);
    ASSERT_TRUE(found);
    EXPECT_LT((found->camera_from_target.translation - truth.translation).norm(), 0.005 * distance)
        << trial;
    const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
    EXPECT_GT((found->camera_from_target.rotation * z).dot(truth.rotation * z), std::cos(0.02))
        << trial;
  }
}

TEST_F(PatternLocatorTest, LocatesNothingInUniformImage) {
  const cv::Mat even(240, 320, CV_8UC1, cv::Scalar(120));
  EXPECT_FALSE(locator_.LocateRing(even, PrintPose({0, 0, 2}, 0.2, 0, 0), 5, 10, 4));
}

// Evidence of views of a print about a calibration whose focal length is 'factor' times the
// camera's.
class CalibrationEvidenceTest : public PatternLocatorTest {
 protected:
  std::optional<PatternLocation> LocateWith(double factor, const RigidTransform& truth,
                                            double noise, Random* random) const {
    CameraIntrinsics intrinsics = camera_.intrinsics();
    intrinsics.fx_px *= factor;
    intrinsics.fy_px *= factor;
    const CameraModel assumed(intrinsics);
    const PatternLocator locator(assumed, pattern_);
    RigidTransform start = truth;
    start.translation.z() *= factor;
    const cv::Mat image = AddNoise(Draw(truth), noise, random);
    PrintAlignment alignment{PlaneWarp(assumed, start, locator.outline().radius_m()), {}};
    if (!AlignPrint(image, image, {}, locator.outline().all(), 6, 10, &alignment)) {
      return std::nullopt;
    }
    return locator.Locate(alignment.edges, start);
  }
  // A pose near enough for the perspective to show the distance, and at an angle.
  static RigidTransform NearPose(Random* random) {
    return PrintPose(
        {random->Uniform(-0.05, 0.05), random->Uniform(-0.05, 0.05), random->Uniform(1.1, 1.3)},
        random->Uniform(0.5, 0.7), random->Uniform(0, 6), random->Uniform(0, 6));
  }
};

TEST_F(CalibrationEvidenceTest, DoesNotContradictRightCalibration) {
  Random random(11);
  constexpr int kTrials = 60;
  double surprise = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto location = LocateWith(1, NearPose(&random), 4, &random);
    ASSERT_TRUE(location);
    const CalibrationEvidence& evidence = location->calibration;
    EXPECT_FALSE(evidence.contradicts) << trial;
    EXPECT_LT(std::abs(evidence.log_focal), 4 * evidence.log_focal_sigma) << trial;
    surprise += evidence.surprise;
  }
  EXPECT_LT(surprise / kTrials, 4) << "three on average";
}

TEST_F(CalibrationEvidenceTest, EstimatesWrongFocalLengthWithinSigma) {
  Random random(12);
  for (const double factor : {0.95, 1.05}) {
    constexpr int kTrials = 30;
    double squares = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto location = LocateWith(factor, NearPose(&random), 4, &random);
      ASSERT_TRUE(location);
      const CalibrationEvidence& evidence = location->calibration;
      EXPECT_LT(evidence.log_focal_sigma, 0.16) << "a noisy view halves what is known before";
      const double error = (evidence.log_focal + std::log(factor)) / evidence.log_focal_sigma;
      squares += error * error;
    }
    const double ratio = std::sqrt(squares / kTrials);  // ratio of errors to standard deviations
    // The true principal point is exactly the calibrated one, which the standard deviation ignores.
    EXPECT_LT(ratio, 1.8) << factor;
  }
}

TEST_F(CalibrationEvidenceTest, ContradictedCalibrationDoesNotDistortPose) {
  Random random(13);
  for (const double factor : {0.8, 1.25}) {
    for (int trial = 0; trial < 8; ++trial) {
      const RigidTransform truth = NearPose(&random);
      const auto location = LocateWith(factor, truth, 2, &random);
      ASSERT_TRUE(location);
      EXPECT_TRUE(location->calibration.contradicts) << factor;
      EXPECT_LT((location->center_px - Center(truth)).norm(), 0.5) << factor;
      EXPECT_LT(location->edge_rms_px, 0.4) << factor;
      const auto error = PoseError(location->camera_from_target, truth);
      EXPECT_LT(std::sqrt(error.dot(location->covariance.ldlt().solve(error)) / 6), 4) << factor;
      EXPECT_LT(error.head<3>().norm(), 0.15 * truth.translation.norm()) << factor;
    }
  }
}

TEST_F(CalibrationEvidenceTest, MisfitRefersToCalibratedLens) {
  Random random(16);
  const RigidTransform truth = PrintPose({0.3, -0.2, 1.4}, 0.6, 1, 0.3);
  const auto right = LocateWith(1, truth, 2, &random);
  const auto wrong = LocateWith(1.25, truth, 2, &random);
  ASSERT_TRUE(right && wrong);
  EXPECT_NEAR(right->misfit_px, right->edge_rms_px, 1e-4);
  ASSERT_TRUE(wrong->calibration.contradicts);
  EXPECT_LT(wrong->edge_rms_px, 0.4);
  // The centre is 57 px from the principal point. It moves by about a quarter of that, and by the
  // estimated error of the principal point.
  EXPECT_GT(wrong->misfit_px, 4);
}

// One view leaves something open; views from several sides determine one focal length.
TEST_F(CalibrationEvidenceTest, ViewsAccumulateToFocalLength) {
  Random random(17);
  for (const double factor : {0.8, 1.0, 1.25}) {
    Eigen::Matrix4d information = Eigen::Vector4d(4, 400, 400, 100).asDiagonal();
    Eigen::Vector4d pull = Eigen::Vector4d::Zero();
    for (int trial = 0; trial < 20; ++trial) {
      // Near enough to show the perspective, but not so near that the ring spans much of a wide
      // lens.
      const RigidTransform pose =
          PrintPose({0.05, -0.05, random.Uniform(1.75, 2.1)}, random.Uniform(0.5, 0.7),
                    random.Uniform(0, 6), random.Uniform(0, 6));
      const auto location = LocateWith(factor, pose, 4, &random);
      ASSERT_TRUE(location);
      information += location->calibration.information;
      pull += location->calibration.pull;
    }
    const Eigen::Vector4d error = information.ldlt().solve(pull);
    EXPECT_NEAR(error(0), -std::log(factor), 0.02) << factor;
    EXPECT_LT(error.segment<2>(1).norm(), 0.02) << factor;
    EXPECT_NEAR(error(3), 0, 0.05) << factor;
  }
}

// A far print that faces the camera has the same size under any focal length.
TEST_F(CalibrationEvidenceTest, FarViewGivesLittleEvidence) {
  Random random(14);
  for (int trial = 0; trial < 10; ++trial) {
    const auto location = LocateWith(1.1, PrintPose({0.1, 0.05, 4}, 0.1, 1, 0.3), 4, &random);
    ASSERT_TRUE(location);
    EXPECT_GT(location->calibration.log_focal_sigma, 0.1);
    EXPECT_FALSE(location->calibration.contradicts);
  }
}

TEST_F(CalibrationEvidenceTest, PartialViewGivesNoEvidence) {
  Random random(15);
  const auto location = LocateWith(1.1, PrintPose({1.05, 0, 1.6}, 0, 0, 0), 2, &random);
  ASSERT_TRUE(location);
  EXPECT_EQ(location->calibration.log_focal, 0);
  EXPECT_EQ(location->calibration.log_focal_sigma, CalibrationEvidence().log_focal_sigma);
  EXPECT_FALSE(location->calibration.contradicts);
  EXPECT_EQ(location->calibration.information.norm(), 0);
}

}  // namespace
}  // namespace kestrel
