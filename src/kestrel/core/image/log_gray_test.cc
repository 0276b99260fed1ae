// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/log_gray.h"

#include <vector>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(LogGray, ShadowShiftsBlackAndWhiteEqually) {
  const LogGrays log;
  constexpr float kShade = 0.4f, kBlack = 50, kWhite = 220;
  const float of_white = log(kWhite) - log(kShade * kWhite);
  const float of_black = log(kBlack) - log(kShade * kBlack);
  EXPECT_NEAR(of_white, of_black, 0.2 * of_white);
  EXPECT_GT(log(kShade * kWhite), log(kBlack));
}

TEST(LogGray, WritesEveryPixelOfSubImage) {
  cv::Mat image(3, 5, CV_8UC1);
  for (int i = 0; i < 15; ++i) image.data[i] = static_cast<std::uint8_t>(17 * i);
  const cv::Mat part = image(cv::Rect(1, 1, 3, 2));
  std::vector<std::uint8_t> memory(part.total());
  const cv::Mat written = WriteLogGrays(part, memory.data());
  const LogGrays log;
  ASSERT_EQ(written.size(), part.size());
  EXPECT_EQ(written.data, memory.data());
  for (int y = 0; y < part.rows; ++y) {
    for (int x = 0; x < part.cols; ++x) {
      EXPECT_NEAR(written.at<std::uint8_t>(y, x), 255 * log(part.at<std::uint8_t>(y, x)), 0.51);
    }
  }
}

}  // namespace
}  // namespace kestrel
