// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/camera/picture_quality.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace kestrel {
namespace {

// Squares of 16 px, dark and light.
cv::Mat Squares(int dark, int light) {
  cv::Mat image(240, 320, CV_8UC1, cv::Scalar(dark));
  for (int row = 0; row < 15; ++row) {
    for (int column = row % 2; column < 20; column += 2) {
      image(cv::Rect(16 * column, 16 * row, 16, 16)).setTo(light);
    }
  }
  return image;
}

cv::Mat Blurred(const cv::Mat& image, double sigma_px) {
  cv::Mat blurred;
  cv::GaussianBlur(image, blurred, {}, sigma_px);
  return blurred;
}

TEST(PictureQualityTest, SharpnessDecreasesWithBlur) {
  const cv::Mat sharp = Squares(60, 190);
  double before = MeasurePicture(sharp).sharpness;
  EXPECT_LE(before, 100);
  for (const double sigma_px : {1.0, 2.0, 4.0}) {
    const double after = MeasurePicture(Blurred(sharp, sigma_px)).sharpness;
    EXPECT_LT(after, 0.8 * before) << sigma_px;
    before = after;
  }
}

TEST(PictureQualityTest, SharpnessDoesNotDependOnExposure) {
  EXPECT_NEAR(MeasurePicture(Squares(30, 95)).sharpness, MeasurePicture(Squares(60, 190)).sharpness,
              1);
}

TEST(PictureQualityTest, MeasuresBrightnessAndClippingOfWholePicture) {
  const PictureQuality half = MeasurePicture(Squares(51, 255));
  EXPECT_NEAR(half.brightness, 60, 0.5);
  EXPECT_NEAR(half.clipped, 50, 0.5);
  const PictureQuality gray = MeasurePicture(cv::Mat(48, 64, CV_8UC1, cv::Scalar(128)));
  EXPECT_EQ(gray.clipped, 0);
  EXPECT_EQ(gray.sharpness, 0);
}

}  // namespace
}  // namespace kestrel
