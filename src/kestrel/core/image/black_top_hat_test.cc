// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/black_top_hat.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/base/test_targets.h"
#include "kestrel/core/image/test_images.h"

namespace kestrel {
namespace {

// Largest or smallest gray value of the square around each pixel. The border is repeated.
cv::Mat Filter(const cv::Mat& image, bool largest) {
  constexpr int kReach = BlackTopHat::kSquarePx / 2;
  cv::Mat filtered(image.size(), CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      std::uint8_t best = image.at<std::uint8_t>(y, x);
      for (int dy = -kReach; dy <= kReach; ++dy) {
        for (int dx = -kReach; dx <= kReach; ++dx) {
          const std::uint8_t gray = image.at<std::uint8_t>(std::clamp(y + dy, 0, image.rows - 1),
                                                           std::clamp(x + dx, 0, image.cols - 1));
          best = largest ? std::max(best, gray) : std::min(best, gray);
        }
      }
      filtered.at<std::uint8_t>(y, x) = best;
    }
  }
  return filtered;
}

void ExpectBinarizedAsDefined(const cv::Mat& image, int min_contrast) {
  const cv::Mat light = Filter(Filter(image, true), false);
  const cv::Mat darkest = Filter(image, false);
  BinaryImage binary;
  BlackTopHat().Binarize(image, min_contrast, &binary);
  int wrong = 0;
  for (int y = -1; y <= image.rows; ++y) {
    for (int x = -1; x <= image.cols; ++x) {
      bool dark = false, bright = false;
      if (x >= 0 && y >= 0 && x < image.cols && y < image.rows) {
        const int gray = image.at<std::uint8_t>(y, x);
        const int black = darkest.at<std::uint8_t>(y, x), white = light.at<std::uint8_t>(y, x);
        const int contrast = white - black;
        dark = contrast >= min_contrast && gray < black + contrast * 171 / 256;
        bright = contrast >= min_contrast && gray > white - contrast / 4;
      }
      wrong += binary.dark.at(x, y) != dark;
      wrong += binary.bright.at(x, y) != bright;
    }
  }
  EXPECT_EQ(wrong, 0) << image.cols << "x" << image.rows << ", contrast " << min_contrast;
}

TEST(BlackTopHat, DecidesEveryPixelAsDefined) {
  ForEveryTarget([] {
    Random random(1);
    for (int trial = 0; trial < 40; ++trial) {
      const int width = random.Integer(1, 300);
      const int height = random.Integer(1, 40);
      const int stride = width + random.Integer(0, 40);
      const ExactImage exact = RandomImage(width, height, stride, &random);
      ExpectBinarizedAsDefined(exact.image, random.Integer(1, 60));
    }
  });
}

TEST(BlackTopHat, WorksForEveryWidth) {
  Random random(2);
  for (int width = 1; width <= 130; ++width) {
    ExpectBinarizedAsDefined(RandomImage(width, 9, width, &random).image, 20);
  }
}

TEST(BlackTopHat, DetectsStrokesInSunAndShadowButNoShadows) {
  cv::Mat image(64, 64, CV_8UC1, cv::Scalar(200));
  image.colRange(20, 22) = 20;  // in the sun
  image.colRange(32, 64) = 60;  // in a shadow
  image.colRange(33, 36) = 6;   // at its edge
  image.colRange(50, 64) = 30;  // dark ground, wider than the square
  BinaryImage binary;
  BlackTopHat().Binarize(image, 20, &binary);
  for (int x = 0; x < 64; ++x) {
    const bool stroke = (x >= 20 && x < 22) || (x >= 33 && x < 36);
    EXPECT_EQ(binary.dark.at(x, 30), stroke) << x;
    EXPECT_FALSE(binary.dark.at(x, 30) && binary.bright.at(x, 30)) << x;
  }
  EXPECT_TRUE(binary.bright.at(23, 30));
  EXPECT_TRUE(binary.bright.at(37, 30)) << "white in a shadow, beside a stroke";
  EXPECT_FALSE(binary.bright.at(10, 30)) << "nothing dark is near";
}

}  // namespace
}  // namespace kestrel
