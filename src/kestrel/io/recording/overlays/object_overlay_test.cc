// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/overlays/object_overlay.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

const cv::Mat kImage(200, 300, CV_8UC3, cv::Scalar(60, 120, 60));

HuntObservation DiscAt(const Eigen::Vector2d& center, Completeness completeness) {
  ObjectDetection detection;
  detection.center_px = center;
  detection.ellipse = {center, 30, 20, 0};
  detection.completeness = completeness;
  HuntObservation observation;
  observation.report.detections = {detection};
  return observation;
}

// Returns the brightest pixel a few px outside of the outline, left of the centre.
int BrightestOutside(const cv::Mat& image, int u, int v) {
  int brightest = 0;
  for (int x = u - 38; x < u - 30; ++x) {
    brightest = std::max<int>(brightest, image.at<cv::Vec3b>(v, x)[0]);
  }
  return brightest;
}

TEST(ObjectOverlay, DrawsAroundObjectOnCopy) {
  const cv::Mat drawn =
      DrawObjectOverlay(kImage, DefaultObjectModel(), DiscAt({100, 90}, Completeness::kWhole));
  ASSERT_EQ(drawn.size(), kImage.size());
  EXPECT_GT(BrightestOutside(drawn, 100, 90), 200);
  EXPECT_EQ(drawn.at<cv::Vec3b>(90, 85), cv::Vec3b(60, 120, 60)) << "the object stays visible";
  EXPECT_EQ(cv::countNonZero(kImage.reshape(1) == 255), 0);
}

TEST(ObjectOverlay, DrawsPartsInGray) {
  const cv::Mat drawn =
      DrawObjectOverlay(kImage, DefaultObjectModel(), DiscAt({100, 90}, Completeness::kMerged));
  EXPECT_GT(BrightestOutside(drawn, 100, 90), 100);
  EXPECT_LT(BrightestOutside(drawn, 100, 90), 180);
}

TEST(ObjectOverlay, DrawsDecoysInGrayWithReason) {
  HuntObservation observation = DiscAt({100, 90}, Completeness::kWhole);
  std::swap(observation.report.detections, observation.report.elsewhere);
  const cv::Mat drawn = DrawObjectOverlay(kImage, DefaultObjectModel(), observation);
  EXPECT_GT(BrightestOutside(drawn, 100, 90), 100);
  EXPECT_LT(BrightestOutside(drawn, 100, 90), 180);
  EXPECT_GT(cv::norm(drawn(cv::Rect(220, 70, 80, 40)), kImage(cv::Rect(220, 70, 80, 40))), 0)
      << "the reason";
}

TEST(ObjectOverlay, KeepsImageWithoutObjects) {
  const cv::Mat drawn = DrawObjectOverlay(kImage, DefaultObjectModel(), HuntObservation());
  EXPECT_EQ(cv::norm(drawn, kImage, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace kestrel
