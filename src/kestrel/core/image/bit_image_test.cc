// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/bit_image.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

TEST(BitImage, IsClearAroundTheImage) {
  BitImage image;
  for (const int width : {1, 63, 64, 65, 128}) {
    image.Reset(width, 3);
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < width; ++x) image.Set(x, y);
    }
    for (int y = -1; y <= 3; ++y) {
      for (int x = -1; x <= width; ++x) {
        EXPECT_EQ(image.at(x, y), x >= 0 && x < width && y >= 0 && y < 3) << x << ", " << y;
      }
    }
  }
}

TEST(BitImage, ResetClears) {
  BitImage image;
  image.Reset(200, 100);
  for (int i = 0; i < 100; ++i) image.Set(2 * i, i);
  image.Reset(70, 30);
  for (int y = -1; y <= 30; ++y) {
    for (int x = -1; x <= 70; ++x) ASSERT_FALSE(image.at(x, y));
  }
}

TEST(CloseBits, AgreesWithOpenCv) {
  Random random(1);
  const cv::Mat cross = cv::getStructuringElement(cv::MORPH_CROSS, cv::Size(3, 3));
  BitImage bits, scratch;
  for (int trial = 0; trial < 60; ++trial) {
    const int width = trial < 6 ? 62 + trial : random.Integer(1, 200);
    const int height = random.Integer(1, 40);
    const double share = random.Uniform(0.1, 0.8);
    cv::Mat image(height, width, CV_8UC1);
    bits.Reset(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        image.at<std::uint8_t>(y, x) = random.Chance(share) ? 255 : 0;
        if (image.at<std::uint8_t>(y, x)) bits.Set(x, y);
      }
    }
    cv::Mat closed;
    cv::morphologyEx(image, closed, cv::MORPH_CLOSE, cross);
    CloseBits(&bits, &scratch);
    for (int y = -1; y <= height; ++y) {
      for (int x = -1; x <= width; ++x) {
        const bool outside = x < 0 || y < 0 || x >= width || y >= height;
        const bool at_border = x == 0 || y == 0 || x == width - 1 || y == height - 1;
        // OpenCV treats pixels outside as set; here they are clear, and border pixels stay
        // unchanged.
        const bool expected = !outside && (at_border ? image : closed).at<std::uint8_t>(y, x) != 0;
        ASSERT_EQ(bits.at(x, y), expected) << width << "x" << height << " at " << x << ", " << y;
      }
    }
  }
}

TEST(CloseBits, BridgesGapsOfTwoPixels) {
  BitImage bits, scratch;
  bits.Reset(100, 9);
  for (int y = 2; y < 7; ++y) {
    for (int x = 10; x < 90; ++x) {
      if (x < 62 || x > 63) bits.Set(x, y);  // the gap lies at the end of a word
    }
  }
  CloseBits(&bits, &scratch);
  EXPECT_TRUE(bits.at(62, 4));
  EXPECT_TRUE(bits.at(63, 4));
  EXPECT_FALSE(bits.at(9, 4));
  EXPECT_FALSE(bits.at(90, 4));
}

TEST(InvertBits, LeavesWhatLiesOutsideClear) {
  for (const int width : {1, 63, 64, 65, 130}) {
    BitImage image, inverse;
    image.Reset(width, 3);
    for (int x = 0; x < width; x += 3) image.Set(x, 1);
    InvertBits(image, &inverse);
    for (int y = -1; y <= 3; ++y) {
      for (int x = -1; x <= width; ++x) {
        const bool outside = x < 0 || y < 0 || x >= width || y >= 3;
        ASSERT_EQ(inverse.at(x, y), !outside && !image.at(x, y))
            << "width " << width << " at " << x << ", " << y;
      }
    }
  }
}

}  // namespace
}  // namespace kestrel
