// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/vision/landing/search/search_plan.h"
#include "kestrel/vision/landing/test_landing_detector.h"

namespace kestrel {
namespace {

using LandingHintTest = LandingPatternDetectorTest;

TEST_F(LandingHintTest, ImageOverridesContradictoryUp) {
  TargetHint hint;
  const Eigen::Vector3d normal = pose_.rotation * Eigen::Vector3d::UnitZ();
  hint.up_in_camera = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()) * normal;  // 23 degrees off
  const TargetReport report = Detect(image_, hint);
  ASSERT_TRUE(report.detection) << report.reason;
  EXPECT_LT(PoseError(report.detection->camera_from_target, pose_).head<3>().norm(), 0.015);
}

TEST_F(LandingHintTest, HintFitsPatternThatFillsFisheyeImage) {
  // Half a metre above the board the ring spans 90 degrees, much less than its size divided by its
  // distance.
  const CameraModel fisheye(
      {752, 480, 250, 250, 375.5, 239.5, DistortionModel::kEquidistant, {0, 0, 0, 0}});
  const LandingPatternDetector detector(fisheye, {});
  for (const double distance : {0.45, 0.6, 1.0}) {
    const RigidTransform truth = PrintPose({0.02, 0.03, distance}, 0.1, 1, 0.3);
    const cv::Mat image = DrawPrint(fisheye, pattern_, SpokedPrint(pattern_, 4), truth);
    TargetHint hint;
    hint.center_in_camera = truth.translation;
    hint.center_sigma_m = 0.1;
    hint.altitude_m = distance + 2;  // above the ground, while the print is on a roof
    const TargetReport report = detector.Detect(image, hint, workspace_);
    ASSERT_TRUE(report.detection) << distance << " m: " << report.reason;
    EXPECT_LT(PoseError(report.detection->camera_from_target, truth).head<3>().norm(), 0.005);
  }
}

// With two patterns side by side, the expected one is chosen.
TEST_F(LandingHintTest, HintSelectsOneOfTwoPatterns) {
  const RigidTransform left = PrintPose({-1.1, 0.1, 4}, 0.1, 1, 0.3);
  const RigidTransform right = PrintPose({1.1, -0.1, 4}, 0.1, 1, 0.6);
  cv::Mat image = Draw(SpokedPrint(pattern_, 4), left);
  const cv::Rect half(image.cols / 2, 0, image.cols / 2, image.rows);
  Draw(SpokedPrint(pattern_, 4), right)(half).copyTo(image(half));
  for (const RigidTransform& pose : {left, right}) {
    TargetHint hint;
    hint.center_in_camera = pose.translation + Eigen::Vector3d(0.05, 0.05, 0.1);
    hint.center_sigma_m = 0.1;
    const TargetReport report = Detect(image, hint);
    ASSERT_TRUE(report.detection) << report.reason;
    EXPECT_LT((report.detection->camera_from_target.translation - pose.translation).norm(), 0.05);
  }
}

// However wrong the hint is, a pattern in plain view is found and located.
TEST_F(LandingHintTest, WrongHintDoesNotHidePattern) {
  struct WrongHint {
    const char* what;
    TargetHint hint;
  };
  const auto center = [](const Eigen::Vector3d& at) {
    TargetHint hint;
    hint.center_in_camera = at;
    hint.center_sigma_m = 0.1;
    return hint;
  };
  const auto altitude = [](double altitude_m) {
    TargetHint hint;
    hint.altitude_m = altitude_m;
    return hint;
  };
  const auto up = [](const Eigen::Vector3d& in_camera) {
    TargetHint hint;
    hint.up_in_camera = in_camera;
    return hint;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double distance : {1.1, 3.0, 9.0}) {
    const RigidTransform truth =
        PrintPose({0.05 * distance, -0.03 * distance, distance}, 0.25, 1, 0.3);
    const Eigen::Vector3d& at = truth.translation;
    const Eigen::Vector3d normal = truth.rotation * Eigen::Vector3d::UnitZ();
    Eigen::Vector3d turned_round = normal;
    turned_round.head<2>() *= -1;
    TargetHint all_wrong = center({-0.5 * distance, 0.1, 2 * distance});
    all_wrong.up_in_camera = -normal;
    all_wrong.altitude_m = distance + 500;
    const WrongHint wrong[] = {
        {"altitude + 10 m", altitude(distance + 10)},
        {"altitude + 500 m", altitude(distance + 500)},
        {"altitude x 3", altitude(3 * distance)},
        {"altitude negative", altitude(-20)},
        {"altitude not a number", altitude(kNan)},
        {"upside down", up(-normal)},
        {"turned round", up(turned_round)},
        {"on edge", up(normal.unitOrthogonal())},
        {"track beside it", center(at + Eigen::Vector3d(0.5 * distance, 0, 0))},
        {"track out of the image", center({10 * distance, 0, distance})},
        {"track behind the camera", center(-at)},
        {"track three times as far", center(3 * at)},
        {"track at a third", center(at / 3)},
        {"track not a number", center({kNan, 0, 1})},
        {"all of it", all_wrong},
    };
    const cv::Mat image = Draw(SpokedPrint(pattern_, 4), truth);
    Eigen::Vector2d center_px;
    camera_.Project(at, &center_px);
    for (const WrongHint& given : wrong) {
      const TargetReport report = Detect(image, given.hint);
      ASSERT_TRUE(report.detection) << given.what << " at " << distance << " m: " << report.reason;
      EXPECT_LT((report.detection->center_px - center_px).norm(), 0.2)
          << given.what << " at " << distance << " m";
      // A wrong 'up' may choose the mirror pose, which agrees better with it.
      EXPECT_LT((report.detection->camera_from_target.translation - at).norm(), 0.1 * distance)
          << given.what << " at " << distance << " m";
    }
  }
}

TEST_F(LandingHintTest, GoodPredictionNeedsNoSearch) {
  constexpr auto kAreas = static_cast<int>(LandingStage::kAreas);
  for (const double distance : {1.1, 3.0, 6.0, 9.0}) {
    const RigidTransform truth =
        PrintPose({0.03 * distance, 0.02 * distance, distance}, 0.1, 2, 0.5);
    const cv::Mat image = Draw(SpokedPrint(pattern_, 4), truth);
    TargetHint hint;
    hint.up_in_camera = truth.rotation * Eigen::Vector3d::UnitZ();
    const TargetReport searched = Detect(image, hint);
    ASSERT_TRUE(searched.detection);
    EXPECT_GT(searched.diagnostics.candidates[kAreas], 0);
    hint.center_in_camera = truth.translation + Eigen::Vector3d(0.03, -0.02, 0.02 * distance);
    const TargetReport predicted = Detect(image, hint);
    ASSERT_TRUE(predicted.detection);
    EXPECT_EQ(predicted.diagnostics.candidates[kAreas], 0) << distance << " m";
    EXPECT_EQ(predicted.detection->method, searched.detection->method);
    EXPECT_LT((predicted.detection->center_px - searched.detection->center_px).norm(), 0.05);
    EXPECT_LT((predicted.detection->camera_from_target.translation -
               searched.detection->camera_from_target.translation)
                  .norm(),
              0.002 * distance);
    // Half a ring off: within three sigma, so the search finds it.
    hint.center_in_camera = truth.translation + Eigen::Vector3d(0.3, -0.2, 0);
    hint.center_sigma_m = 0.2;
    const TargetReport around = Detect(image, hint);
    ASSERT_TRUE(around.detection);
    EXPECT_GT(around.diagnostics.candidates[kAreas], 0);
  }
}

TEST_F(LandingHintTest, QualityDependsOnImageOnly) {
  TargetHint hint;
  hint.altitude_m = 3;
  const TargetReport right = Detect(image_, hint);
  hint.altitude_m = 9;
  const TargetReport wrong = Detect(image_, hint);
  ASSERT_TRUE(right.detection && wrong.detection);
  EXPECT_EQ(right.detection->quality, Detect(image_).detection->quality);
  EXPECT_EQ(wrong.detection->quality, right.detection->quality);
}

// A pattern that only a late step finds: the search goes on in the next frame where it stopped.
TEST_F(LandingHintTest, SearchOutOfTimeContinuesInNextFrame) {
  LandingPatternDetectorOptions options;
  options.max_search_ms = 1e-6;  // one step a frame
  const LandingPatternDetector bounded(camera_, options);
  const RigidTransform truth = PrintPose({0.3, -0.2, 12}, 0.2, 1, 0.3);
  const cv::Mat image = Draw(SpokedPrint(pattern_, 4), truth);
  TargetHint hint;
  int frames = 0;
  for (;; ++frames) {
    ASSERT_LT(frames, static_cast<int>(kSearchSteps));
    const TargetReport report = bounded.Detect(image, hint, workspace_);
    if (report.detection) {
      EXPECT_EQ(report.diagnostics.next_step, 0);
      EXPECT_LT((report.detection->camera_from_target.translation - truth.translation).norm(),
                0.03 * truth.translation.norm());
      break;
    }
    EXPECT_GT(report.diagnostics.next_step, hint.first_step);
    hint.first_step = report.diagnostics.next_step;
  }
  EXPECT_GT(frames, 1) << "the first steps look for larger rings";
}

TEST_F(LandingHintTest, BoundedSearchOfEmptyImageTakesStepsInTurn) {
  LandingPatternDetectorOptions options;
  options.max_search_ms = 1e-6;
  const LandingPatternDetector bounded(camera_, options);
  const cv::Mat image = Draw(SpokedPrint(pattern_, 3), pose_);
  for (const bool is_given : {false, true}) {
    TargetHint hint;
    if (is_given) hint.center_in_camera = pose_.translation;
    std::set<int> steps;
    for (int frame = 0; frame < 2 * static_cast<int>(kSearchSteps); ++frame) {
      const TargetReport report = bounded.Detect(image, hint, workspace_);
      EXPECT_FALSE(report.detection);
      steps.insert(report.diagnostics.next_step);
      hint.first_step = report.diagnostics.next_step;
    }
    // Without a hint, the likely part is the whole image, so there is only one round.
    EXPECT_GE(steps.size(), kSearchSteps);
    EXPECT_TRUE(steps.contains(0) || steps.contains(static_cast<int>(kSearchSteps)));
    EXPECT_TRUE(std::all_of(steps.begin(), steps.end(), [](int step) {
      return step >= 0 && step < 2 * static_cast<int>(kSearchSteps);
    }));
  }
}

TEST_F(LandingHintTest, UnboundedSearchIsComplete) {
  LandingPatternDetectorOptions options;
  options.max_search_ms = 1e9;
  const LandingPatternDetector generous(camera_, options);
  const cv::Mat far = Draw(SpokedPrint(pattern_, 4), PrintPose({0.3, -0.2, 9}, 0.2, 1, 0.3));
  const cv::Mat other = Draw(SpokedPrint(pattern_, 3), pose_);
  for (const cv::Mat& image : {image_, far, other}) {
    const TargetReport whole = Detect(image);
    EXPECT_EQ(whole.diagnostics.next_step, 0);
    ExpectSame(generous.Detect(image, {}, workspace_), whole);
    for (const int first_step : {1, 7, 19, 30, -5, 1000}) {
      TargetHint hint;
      hint.first_step = first_step;
      const TargetReport report = Detect(image, hint);
      EXPECT_EQ(report.detection.has_value(), whole.detection.has_value()) << first_step;
      EXPECT_EQ(report.diagnostics.next_step, 0) << first_step;
    }
  }
}

TEST_F(LandingHintTest, AttitudeResolvesMirrorPose) {
  Random random(3);
  for (int trial = 0; trial < 6; ++trial) {
    const RigidTransform truth =
        PrintPose({0.2, 0.1, 7}, 0.5, random.Uniform(0, 6), random.Uniform(0, 6));
    const Eigen::Vector3d up = truth.rotation * Eigen::Vector3d::UnitZ();
    TargetHint hint;
    hint.up_in_camera = up;
    const TargetReport report =
        Detect(AddNoise(Draw(SpokedPrint(pattern_, 4), truth), 2, &random), hint);
    ASSERT_TRUE(report.detection) << trial << ": " << report.reason;
    const Eigen::Vector3d found =
        report.detection->camera_from_target.rotation * Eigen::Vector3d::UnitZ();
    EXPECT_GT(found.dot(up), 0.95) << trial;
  }
}

}  // namespace
}  // namespace kestrel
