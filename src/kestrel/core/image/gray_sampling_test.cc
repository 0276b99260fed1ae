// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/gray_sampling.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/base/test_targets.h"

namespace kestrel {
namespace {

TEST(SampleGray, InterpolatesWithinImageOnly) {
  cv::Mat image(5, 7, CV_8UC1);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 7; ++x) {
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(10 * x + 20 * y);
    }
  }
  for (const float y : {0.f, 0.25f, 2.5f, 4.f}) {
    for (const float x : {0.f, 1.75f, 5.5f, 6.f}) {
      EXPECT_FLOAT_EQ(SampleGray(image, x, y), 10 * x + 20 * y);
    }
  }
  EXPECT_LT(SampleGray(image, -0.01f, 2), 0);
  EXPECT_LT(SampleGray(image, 6.01f, 2), 0);
  EXPECT_LT(SampleGray(image, 2, 4.01f), 0);
  EXPECT_LT(SampleGray(image, NAN, 2), 0);
  EXPECT_FLOAT_EQ(SampleGray(image(cv::Rect(2, 1, 3, 3)), 1, 1), 70) << "rows are strided";
}

cv::Mat NoiseImage(int width, int height, Random* random) {
  cv::Mat image(height, width, CV_8UC1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(random->Uniform(0, 256));
    }
  }
  return image;
}

void ExpectSamplesOfOneAfterTheOther() {
  Random random(1);
  const cv::Mat whole = NoiseImage(23, 17, &random);
  // The last rows of the whole image end at the end of its memory.
  for (const cv::Mat& image : {whole, whole(cv::Rect(3, 2, 9, 15)), NoiseImage(2, 2, &random)}) {
    for (const std::size_t count : {0u, 1u, 7u, 8u, 9u, 16u, 61u}) {
      std::vector<float> x(count), y(count), gray(count);
      for (std::size_t i = 0; i < count; ++i) {
        x[i] = static_cast<float>(random.Uniform(-2, image.cols + 1));
        y[i] = static_cast<float>(random.Uniform(-2, image.rows + 1));
      }
      if (count > 2) x[1] = NAN;
      if (count > 2) x[2] = static_cast<float>(image.cols - 1);
      if (count > 2) y[2] = static_cast<float>(image.rows - 1);
      SampleGrays(image, x.data(), y.data(), count, gray.data());
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_NEAR(gray[i], SampleGray(image, x[i], y[i]), 1e-3) << x[i] << " " << y[i];
      }
    }
  }
}

TEST(SampleGrays, EqualsSingleSamples) { ForEveryTarget(ExpectSamplesOfOneAfterTheOther); }

}  // namespace
}  // namespace kestrel
