// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/rendering/sensor.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/simulation/rendering/test_worlds.h"

namespace kestrel {
namespace {

const Lens& TestLens() {
  static const Lens lens(CameraModel(SmallFisheye()), {.vignette = 0, .airframe = {}});
  return lens;
}

SensorOptions Noiseless() {
  SensorOptions options;
  options.read_noise = 0;
  options.shot_noise = 0;
  options.blur_sigma_px = 0;
  options.black_level = 10;
  options.white_level = 210;
  return options;
}

cv::Mat Even(float radiance) { return {TestLens().gain().size(), CV_32F, cv::Scalar(radiance)}; }

// Returns mean and standard deviation in the middle of the image.
cv::Vec2d Statistics(const cv::Mat& image) {
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(image(cv::Rect(60, 40, 120, 80)), mean, deviation);
  return {mean[0], deviation[0]};
}

TEST(SensorTest, AppliesLevelsGainAndSaturation) {
  const SensorOptions options = Noiseless();
  EXPECT_EQ(Statistics(Expose(options, TestLens(), 1, 1, Even(0)))[0], 10);
  EXPECT_NEAR(Statistics(Expose(options, TestLens(), 1, 1, Even(0.5f)))[0], 110, 0.1);
  EXPECT_NEAR(Statistics(Expose(options, TestLens(), 0.5, 1, Even(0.5f)))[0], 60, 0.1);
  EXPECT_NEAR(Statistics(Expose(options, TestLens(), 1, 1, Even(3)))[0], 255, 0.1);
}

TEST(SensorTest, GammaBrightensDarkTones) {
  SensorOptions options = Noiseless();
  options.gamma = 0.5;
  options.black_level = 0;
  options.white_level = 255;
  EXPECT_NEAR(Statistics(Expose(options, TestLens(), 1, 1, Even(0.25f)))[0], 127.5, 1);
}

TEST(SensorTest, NoiseGrowsWithRootOfLight) {
  SensorOptions options = Noiseless();
  options.read_noise = 2;
  EXPECT_NEAR(Statistics(Expose(options, TestLens(), 1, 1, Even(0.5f)))[1], 2, 0.1);
  options.read_noise = 0;
  options.shot_noise = 3;
  EXPECT_NEAR(Statistics(Expose(options, TestLens(), 1, 1, Even(0.5f)))[1], 3, 0.15);
  EXPECT_NEAR(Statistics(Expose(options, TestLens(), 1, 1, Even(0.125f)))[1], 1.5, 0.1);
}

TEST(SensorTest, SeedDeterminesNoise) {
  const SensorOptions options;
  const cv::Mat one = Expose(options, TestLens(), 1, 1, Even(0.5f));
  EXPECT_EQ(cv::norm(one, Expose(options, TestLens(), 1, 1, Even(0.5f)), cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(one, Expose(options, TestLens(), 1, 2, Even(0.5f)), cv::NORM_INF), 0);
}

}  // namespace
}  // namespace kestrel
