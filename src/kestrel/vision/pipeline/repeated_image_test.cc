// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/repeated_image.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace kestrel {
namespace {

cv::Mat NoisyImage(int seed) {
  cv::Mat image(480, 752, CV_8UC1);
  cv::RNG random(seed);
  random.fill(image, cv::RNG::NORMAL, 100, 1.2);
  return image;
}

TEST(RepeatedImageTest, NoiseMakesImagesDiffer) {
  RepeatedImage repeated;
  for (int seed = 1; seed <= 5; ++seed) EXPECT_FALSE(repeated.IsRepeated(NoisyImage(seed)));
  EXPECT_EQ(repeated.in_a_row(), 0);
}

TEST(RepeatedImageTest, CountsRepetitionsUntilImageChanges) {
  RepeatedImage repeated;
  const cv::Mat image = NoisyImage(1);
  EXPECT_FALSE(repeated.IsRepeated(image));
  EXPECT_TRUE(repeated.IsRepeated(image.clone()));
  EXPECT_TRUE(repeated.IsRepeated(image.clone()));
  EXPECT_EQ(repeated.in_a_row(), 2);
  EXPECT_FALSE(repeated.IsRepeated(NoisyImage(2)));
  EXPECT_EQ(repeated.in_a_row(), 0);
}

TEST(RepeatedImageTest, AnotherSizeIsAnotherImage) {
  RepeatedImage repeated;
  const cv::Mat image = NoisyImage(1);
  EXPECT_FALSE(repeated.IsRepeated(image));
  EXPECT_FALSE(repeated.IsRepeated(image(cv::Rect(0, 0, 376, 240))));
}

}  // namespace
}  // namespace kestrel
