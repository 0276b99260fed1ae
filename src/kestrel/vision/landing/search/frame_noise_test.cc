// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/search/frame_noise.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

// A landing pattern over most of the image: ink of 5 gray values and white of 25.
cv::Mat DarkFrame() {
  const LandingPattern pattern;
  cv::Mat image = DrawPrint(TestPrintCamera(), pattern, SpokedPrint(pattern, 4),
                            PrintPose({0.05, -0.04, 1.1}, 0.25, 1, 0.3));
  image.convertTo(image, CV_8U, 0.125);
  return image;
}

double RmsDifference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L2) / std::sqrt(static_cast<double>(a.total()));
}

TEST(FrameNoiseTest, MeasuresNoiseAndContrast) {
  Random random(1);
  cv::Mat bright;
  DarkFrame().convertTo(bright, CV_8U, 6, 40);
  for (const double sigma : {2.0, 5.0, 10.0}) {
    const cv::Mat noisy = AddNoise(bright, sigma, &random);
    EXPECT_NEAR(MeasureNoise(noisy), sigma, 0.15 * sigma);
    EXPECT_NEAR(MeasureContrast(noisy), 6 * 20, 12);
  }
}

TEST(FrameNoiseTest, DoesNotCountTextureAsNoise) {
  Random random(2);
  const cv::Mat even(240, 320, CV_8UC1, cv::Scalar(128));
  cv::Mat texture = AddNoise(even, 60, &random);
  cv::GaussianBlur(texture, texture, {}, 2);
  EXPECT_LT(MeasureNoise(texture), 0.05 * MeasureContrast(texture));
}

TEST(FrameNoiseTest, IsZeroWithoutRowsOrColumns) {
  EXPECT_EQ(MeasureNoise(cv::Mat(1, 1, CV_8UC1, cv::Scalar(9))), 0);
  EXPECT_EQ(MeasureNoise(cv::Mat(1, 100, CV_8UC1, cv::Scalar(9))), 0);
}

TEST(NoiseFilterTest, KeepsFramesWithLittleNoise) {
  Random random(3);
  NoiseFilter filter;
  const cv::Mat dark = DarkFrame();
  EXPECT_EQ(&filter.Filter(dark), &dark);
  cv::Mat bright;
  dark.convertTo(bright, CV_8U, 6, 40);
  const cv::Mat noisy = AddNoise(bright, 5, &random);
  EXPECT_EQ(&filter.Filter(noisy), &noisy);
}

TEST(NoiseFilterTest, ReducesNoiseOfDarkFrames) {
  Random random(4);
  NoiseFilter filter;
  const cv::Mat dark = DarkFrame();
  constexpr double kSigma = 4;
  const cv::Mat noisy = AddNoise(dark, kSigma, &random);
  const cv::Mat& filtered = filter.Filter(noisy);
  ASSERT_NE(&filtered, &noisy);
  ASSERT_EQ(filtered.size(), dark.size());
  cv::Mat wanted;  // what a frame without noise would become
  cv::GaussianBlur(dark, wanted, {}, std::sqrt(2.0));
  const double gain = cv::mean(filtered)[0] / cv::mean(wanted)[0];
  EXPECT_GT(gain, 3);
  wanted.convertTo(wanted, CV_8U, gain);
  EXPECT_LT(RmsDifference(filtered, wanted), 0.35 * gain * kSigma);
}

}  // namespace
}  // namespace kestrel
