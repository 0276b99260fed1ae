// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/helipad/helipad_detector.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/helipad/test_ground_textures.h"
#include "kestrel/vision/helipad/test_helipad_images.h"
#include "kestrel/vision/helipad/test_helipad_lookalikes.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

class HelipadDetectorTest : public ::testing::Test {
 protected:
  void Use(const HelipadDetectorOptions& options) {
    options_ = options;
    detector_ = std::make_unique<HelipadDetector>(camera_, options);
    workspace_ = detector_->MakeWorkspace();
  }
  cv::Mat Image(const RigidTransform& pose, std::uint64_t seed) const {
    return renderer_.Render(PrintOf(options_), pose, taken_, seed);
  }
  TargetReport Detect(const cv::Mat& image, const TargetHint& hint = {}) {
    return detector_->Detect(image, hint, *workspace_);
  }
  // Returns the number of 'count' random views in which the pad is found at its place. The hint is
  // that of a track where 'sigma_m' is not 0.
  int Found(double altitude, int count, double sigma_m, std::uint64_t seed) {
    int found = 0;
    Random random(seed);
    for (int i = 0; i < count; ++i) {
      const RigidTransform pose = RandomPadBelow(altitude, &random);
      TargetHint hint;
      hint.up_in_camera = pose.rotation * Vector3d::UnitZ();
      if (sigma_m > 0) {
        const double x = random.Normal();
        const double y = random.Normal();
        const double z = random.Normal();
        hint.center_in_camera = pose.translation + sigma_m * Vector3d(x, y, z);
        hint.center_sigma_m = sigma_m;
        hint.rotation_in_camera =
            Eigen::Quaterniond(Eigen::AngleAxisd(0.03, Vector3d::UnitZ())) * pose.rotation;
      }
      const TargetReport report = Detect(Image(pose, seed + i), hint);
      if (!report.detection) continue;
      const RigidTransform& seen = report.detection->camera_from_target;
      const double off = (seen.translation - pose.translation).norm();
      const double turn = seen.rotation.angularDistance(pose.rotation);
      const bool right = off < 0.1 * altitude && std::min(turn, kPi - turn) < Radians(12);
      found += right;
    }
    return found;
  }

  const CameraModel camera_{PaperCamera()};
  const PadRenderer renderer_{camera_};
  PadImageOptions taken_;
  HelipadDetectorOptions options_;
  std::unique_ptr<HelipadDetector> detector_;
  std::unique_ptr<TargetWorkspace> workspace_;
};

TEST_F(HelipadDetectorTest, FindsPadWithoutHint) {
  Use({});
  for (const double altitude : {0.7, 2.0, 4.0, 11.0, 14.0})
    EXPECT_EQ(Found(altitude, 3, 0, 1), 3) << altitude;
}

TEST_F(HelipadDetectorTest, FollowsPadNearAndFar) {
  Use({});
  for (const double altitude : {0.5, 1.0, 4.0, 15.0}) {
    EXPECT_EQ(Found(altitude, 3, 0.02 + 0.03 * altitude, 1), 3) << altitude;
  }
}

TEST_F(HelipadDetectorTest, FindsEachKindOfPad) {
  for (const char* frame : {"circle", "square", "none"}) {
    for (const bool white : {true, false}) {
      HelipadDetectorOptions options;
      options.frame = frame;
      options.white = white;
      Use(options);
      EXPECT_EQ(Found(3, 2, 0, 7), 2) << frame << ", white " << white;
    }
  }
}

// With the camera over one leg, with or without a frame around the H.
TEST_F(HelipadDetectorTest, FollowsSingleLegDownToGround) {
  const Vector3d on_leg(-0.233, 0.2, 0);
  for (const char* frame : {"circle", "none"}) {
    HelipadDetectorOptions options;
    options.frame = frame;
    Use(options);
    Random random(4);
    for (double height = 0.9; height > 0.14; height *= 0.8) {
      const Eigen::Quaterniond down(Eigen::AngleAxisd(kPi, Vector3d::UnitX()));
      RigidTransform pose{down * RotationBy({0, 0, 0.4}), {0, 0, height}};
      pose.translation -= pose.rotation * on_leg;
      const double sigma = 0.005 + 0.02 * height;
      const double x = random.Normal();
      const double y = random.Normal();
      TargetHint hint;
      hint.center_in_camera = pose.translation + sigma * Vector3d(x, y, 0);
      hint.center_sigma_m = sigma;
      hint.rotation_in_camera = RotationBy({0, 0, 0.02}) * pose.rotation;
      hint.up_in_camera = pose.rotation * Vector3d::UnitZ();
      const TargetReport report = Detect(Image(pose, 3), hint);
      ASSERT_TRUE(report.detection) << frame << ", " << height << " m: " << report.reason;
      const RigidTransform& seen = report.detection->camera_from_target;
      EXPECT_LT((seen.translation - pose.translation).norm(), 0.01) << frame << ", " << height;
      EXPECT_LT(seen.rotation.angularDistance(pose.rotation), Radians(1))
          << frame << ", " << height;
    }
  }
}

TEST_F(HelipadDetectorTest, ToleratesMotionAndDust) {
  Use({});
  taken_ = {.motion_px = 5};
  EXPECT_EQ(Found(3, 3, 0.1, 5), 3) << "motion";
  taken_ = {.noise = 5, .contrast = 0.35};
  EXPECT_EQ(Found(5, 3, 0, 5), 3) << "dust";
}

TEST_F(HelipadDetectorTest, ToleratesShadowEdge) {
  Use({});
  Random random(6);
  constexpr int kShadows = 8;
  int found = 0, followed = 0;
  for (int i = 0; i < kShadows; ++i) {
    taken_.shadow = RandomShadow(&random);
    const double altitude = random.Uniform(1, 6);
    found += Found(altitude, 1, 0, i);
    followed += Found(altitude, 1, 0.05, i);
  }
  EXPECT_GE(found, kShadows - 3);
  EXPECT_GE(followed, kShadows - 2);
}

TEST_F(HelipadDetectorTest, CovarianceMatchesErrors) {
  Use({});
  Random random(9);
  double sum = 0;
  constexpr int kViews = 12;
  for (int i = 0; i < kViews; ++i) {
    const double altitude = random.Uniform(1.5, 5);
    const RigidTransform pose = RandomPadBelow(altitude, &random);
    TargetHint hint;
    hint.up_in_camera = pose.rotation * Vector3d::UnitZ();
    const TargetReport report = Detect(Image(pose, 100 + i), hint);
    ASSERT_TRUE(report.detection);
    const RigidTransform& seen = report.detection->camera_from_target;
    EXPECT_EQ(report.detection->heading_symmetry, 2);
    Eigen::Quaterniond turn = seen.rotation * pose.rotation.conjugate();
    if (Eigen::AngleAxisd(turn).angle() > kPi / 2) {
      turn = seen.rotation * Eigen::Quaterniond(0, 0, 0, 1) * pose.rotation.conjugate();
    }
    Eigen::Matrix<double, 6, 1> error;
    error << seen.translation - pose.translation, RotationVector(turn);
    sum += error.dot(report.detection->covariance.ldlt().solve(error));
  }
  // Six degrees of freedom: 6 on average for errors that are as large as their covariance.
  EXPECT_GT(sum / kViews, 1);
  EXPECT_LT(sum / kViews, 14);
}

TEST_F(HelipadDetectorTest, HintResolvesHeading) {
  Use({});
  Random random(4);
  const RigidTransform pose = RandomPadBelow(2, &random);
  const cv::Mat image = Image(pose, 1);
  for (const bool turned : {false, true}) {
    TargetHint hint;
    hint.center_in_camera = pose.translation;
    hint.center_sigma_m = 0.05;
    hint.rotation_in_camera =
        turned ? pose.rotation * Eigen::Quaterniond(0, 0, 0, 1) : pose.rotation;
    const TargetReport report = Detect(image, hint);
    ASSERT_TRUE(report.detection);
    EXPECT_EQ(report.detection->method, DetectionMethod::kFollowed);
    EXPECT_LT(
        report.detection->camera_from_target.rotation.angularDistance(*hint.rotation_in_camera),
        Radians(2));
  }
}

TEST_F(HelipadDetectorTest, RefusesImageOfAnotherCamera) {
  Use({});
  EXPECT_FALSE(Detect(cv::Mat(10, 10, CV_8UC1, cv::Scalar(0))).detection);
  EXPECT_FALSE(Detect(cv::Mat(10, 10, CV_8UC1, cv::Scalar(0))).reason.empty());
  HelipadDetectorOptions wrong;
  wrong.min_quality = 2;
  EXPECT_THROW(HelipadDetector(camera_, wrong), InputError);
}

TEST_F(HelipadDetectorTest, RejectsLookalikes) {
  constexpr int kBoards = 4;  // with nine signs each
  for (const bool white : {true, false}) {
    HelipadDetectorOptions options;
    options.white = white;
    Use(options);
    Random random(3);
    for (int i = 0; i < kBoards; ++i) {
      const LookalikeBoard board = RandomLookalikeBoard(white, &random);
      const double altitude = random.Uniform(1.5, 8);
      const RigidTransform pose = RandomPadBelow(altitude, &random);
      const TargetReport report = Detect(renderer_.Render(board.print, pose, taken_, i));
      EXPECT_FALSE(report.detection) << "board " << i << ", white " << white;
    }
  }
}

// A frame around the H is evidence; what has none is nearer to the scratches of a ground.
TEST_F(HelipadDetectorTest, RejectsTexturesForHWithoutFrame) {
  constexpr int kImages = 8;  // for each kind
  for (const bool white : {true, false}) {
    HelipadDetectorOptions options;
    options.frame = "none";
    options.white = white;
    Use(options);
    for (std::size_t kind = 0; kind < GroundTextures::kKinds.size(); ++kind) {
      for (int i = 0; i < kImages; ++i) {
        GroundTextures textures({camera_.width_px(), camera_.height_px()}, 100 * kind + i);
        EXPECT_FALSE(Detect(textures.Draw(kind)).detection)
            << GroundTextures::kKinds[kind] << " " << i << ", white " << white;
      }
    }
  }
}

}  // namespace
}  // namespace kestrel
