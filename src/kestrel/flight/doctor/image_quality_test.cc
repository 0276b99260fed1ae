// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/image_quality.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace kestrel {
namespace {

// Squares of paper on a gray floor, seen by a camera with some noise.
cv::Mat Scene(double blur_px, double gain) {
  cv::Mat image(240, 320, CV_8UC1, cv::Scalar(90));
  for (int i = 0; i < 12; ++i) {
    const cv::RotatedRect square(cv::Point2f(40.F + 80.F * (i % 4), 40.F + 80.F * (i / 4)),
                                 cv::Size2f(40, 40), 10.F * i);
    cv::Point2f corners[4];
    square.points(corners);
    std::vector<cv::Point> polygon(corners, corners + 4);
    cv::fillConvexPoly(image, polygon, cv::Scalar(i % 2 == 0 ? 215 : 20), cv::LINE_AA);
  }
  if (blur_px > 0) cv::GaussianBlur(image, image, {}, blur_px);
  image.convertTo(image, CV_8U, gain);
  cv::Mat noise(image.size(), CV_8SC1);
  cv::RNG random(1);
  random.fill(noise, cv::RNG::NORMAL, 0, 2);
  cv::Mat noisy;
  cv::add(image, noise, noisy, cv::noArray(), CV_8U);
  return noisy;
}

TEST(ImageQualityTest, EdgeWidthMeasuresBlur) {
  EXPECT_LT(MeasureImageQuality(Scene(0.6, 1)).edge_px.value(), 3);
  const double soft = MeasureImageQuality(Scene(2.0, 1)).edge_px.value();
  EXPECT_GT(soft, 3.5);
  EXPECT_LT(soft, 6);
  EXPECT_GT(MeasureImageQuality(Scene(4.0, 1)).edge_px.value_or(99), 5);
}

TEST(ImageQualityTest, NoiseAloneHasNoEdges) {
  cv::Mat noise(240, 320, CV_8UC1);
  cv::RNG random(2);
  random.fill(noise, cv::RNG::NORMAL, 100, 4);
  EXPECT_FALSE(MeasureImageQuality(noise).edge_px);
}

TEST(ImageQualityTest, DetectsDarkAndSaturatedImages) {
  EXPECT_LT(MeasureImageQuality(Scene(0.6, 0.15)).bright_gray, 50);
  EXPECT_GT(MeasureImageQuality(Scene(0.6, 3)).saturated_share, 0.3);
  const ImageQuality good = MeasureImageQuality(Scene(0.6, 1));
  EXPECT_GT(good.bright_gray, 200);
  EXPECT_LT(good.saturated_share, 0.01);
  EXPECT_LT(good.dark_gray, 40);
}

TEST(ImageQualityTest, HashChangesWithOnePixel) {
  cv::Mat image = Scene(0.6, 1);
  const auto hash = MeasureImageQuality(image).hash;
  EXPECT_EQ(MeasureImageQuality(image.clone()).hash, hash);
  image.at<std::uint8_t>(120, 160) ^= 1;
  EXPECT_NE(MeasureImageQuality(image).hash, hash);
}

TEST(ImageQualityTest, AcceptsColour) {
  cv::Mat color;
  cv::cvtColor(Scene(0.6, 1), color, cv::COLOR_GRAY2BGR);
  EXPECT_GT(MeasureImageQuality(color).bright_gray, 200);
}

}  // namespace
}  // namespace kestrel
