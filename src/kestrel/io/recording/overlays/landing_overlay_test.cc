// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/overlays/landing_overlay.h"

#include <limits>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/target/plane_warp.h"

namespace kestrel {
namespace {

const CameraModel kCamera({640, 480, 400, 400, 319.5, 239.5, DistortionModel::kNone, {}});
const TargetShape kShape = ShapeOf(LandingPattern());
const cv::Mat kGray(480, 640, CV_8UC1, 128);

LandingObservation FoundAt(const Eigen::Vector3d& center_in_camera) {
  TargetDetection detection{};
  // The printed face points to the camera.
  detection.camera_from_target.rotation =
      Eigen::AngleAxisd(3.14159265358979, Eigen::Vector3d::UnitX());
  detection.camera_from_target.translation = center_in_camera;
  kCamera.Project(center_in_camera, &detection.center_px);
  LandingObservation observation;
  observation.report.detection = detection;
  observation.report.reached = LandingStage::kFound;
  return observation;
}

bool IsYellow(const cv::Mat& image, int x, int y) {
  const auto& pixel = image.at<cv::Vec3b>(y, x);
  return pixel[2] > 150 && pixel[1] > 150 && pixel[0] < 90;
}

TEST(LandingOverlay, DrawsRingAtPose) {
  const cv::Mat drawn = DrawLandingOverlay(kGray, kCamera, kShape, FoundAt({0.0, 0.0, 2.0}));
  ASSERT_EQ(drawn.type(), CV_8UC3);
  ASSERT_EQ(drawn.size(), kGray.size());
  // At 2 m the outer radius of 0.5 m is 100 px and the inner one of 0.4 m is 80 px; off the axes.
  EXPECT_TRUE(IsYellow(drawn, 319 - 60, 239 - 80));
  EXPECT_TRUE(IsYellow(drawn, 319 - 48, 239 - 64));
  EXPECT_FALSE(IsYellow(drawn, 319 - 54, 239 - 72));
}

bool IsMagenta(const cv::Mat& image, int x, int y) {
  const auto& pixel = image.at<cv::Vec3b>(y, x);
  return pixel[2] > 150 && pixel[0] > 150 && pixel[1] < 120;
}

// The pattern is seen 40 px to the right of its projection by pose and lens.
TEST(LandingOverlay, DrawsBothOutlinesOfMisfit) {
  LandingObservation observation = FoundAt({0.0, 0.0, 2.0});
  TargetDetection& detection = *observation.report.detection;
  detection.diagnostics.seen =
      SeenPrint{detection.camera_from_target, PlaneWarp::Coefficients::Zero(), 0.5};
  detection.diagnostics.seen->displacement_px(0, 0) = 40;
  detection.diagnostics.misfit_px = 28;
  detection.diagnostics.misfit_bound_px = 30;
  const auto drawn = [&] { return DrawLandingOverlay(kGray, kCamera, kShape, observation); };
  EXPECT_FALSE(IsMagenta(drawn(), 359 + 60, 239 + 80)) << "no more than should be";
  detection.diagnostics.misfit_bound_px = 1;
  EXPECT_TRUE(IsYellow(drawn(), 319 + 60, 239 + 80));
  EXPECT_TRUE(IsMagenta(drawn(), 359 + 60, 239 + 80));
  EXPECT_TRUE(IsMagenta(drawn(), 359 + 48, 239 + 64));
  // The legend of the colours.
  cv::Mat magenta;
  cv::inRange(drawn().rowRange(0, 100), cv::Scalar(150, 0, 150), cv::Scalar(255, 120, 255),
              magenta);
  EXPECT_GT(cv::countNonZero(magenta), 50);
}

// The camera looks down from 2 m; the pad drives 0.5 m to the east, which is to the right.
TEST(LandingOverlay, DrawsPathOfTrack) {
  LandingObservation observation;
  observation.world_from_camera.emplace();
  observation.world_from_camera->rotation =
      Eigen::AngleAxisd(3.14159265358979, Eigen::Vector3d::UnitX());
  observation.world_from_camera->translation = {0, 0, 2};
  const auto is_cyan_at = [&](const std::vector<Eigen::Vector3d>& path, int x) {
    const cv::Mat drawn = DrawLandingOverlay(kGray, kCamera, kShape, observation, {false, path});
    const auto& pixel = drawn.at<cv::Vec3b>(239, x);
    return pixel[0] > 180 && pixel[2] < 90;
  };
  const std::vector<Eigen::Vector3d> path = {{0, 0, 0}, {0.5, 0, 0}};
  EXPECT_TRUE(is_cyan_at(path, 319 + 50)) << "between the two places";
  EXPECT_FALSE(is_cyan_at(path, 319 - 50));
  EXPECT_FALSE(is_cyan_at({}, 319 + 50));
  observation.world_from_camera.reset();
  EXPECT_FALSE(is_cyan_at(path, 319 + 50)) << "no pose";
}

TEST(LandingOverlay, HandlesPatternBesideOrBehindCamera) {
  for (const double z : {1e-9, 0.01, -1.0}) {
    EXPECT_EQ(DrawLandingOverlay(kGray, kCamera, kShape, FoundAt({0.2, 0.1, z})).size(),
              kGray.size());
  }
}

TEST(LandingOverlay, PrintsReasonOfMiss) {
  LandingObservation observation;
  observation.report.reached = LandingStage::kCross;
  observation.report.reason = "no arms";
  const cv::Mat drawn = DrawLandingOverlay(kGray, kCamera, kShape, observation);
  cv::Mat channels[3];
  cv::split(drawn, channels);
  EXPECT_GT(cv::norm(channels[2], kGray, cv::NORM_INF), 100);
  EXPECT_EQ(cv::norm(channels[2].rowRange(100, 480), kGray.rowRange(100, 480), cv::NORM_INF), 0);
}

}  // namespace
}  // namespace kestrel
