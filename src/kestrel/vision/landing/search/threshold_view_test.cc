// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/search/threshold_view.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace kestrel {
namespace {

// A white square on dark ground, with a ring of black paint in it.
cv::Mat Pattern() {
  cv::Mat image(250, 390, CV_8UC1, cv::Scalar(90));
  image(cv::Rect(100, 50, 150, 150)).setTo(230);
  cv::circle(image, {175, 125}, 50, cv::Scalar(20), 16);
  return image;
}

TEST(ThresholdViewTest, PaintIsDarkAndBoardBrightAtEveryResolution) {
  ThresholdView view;
  const cv::Mat image = Pattern();
  for (const int level : {3, 2, 1, 0}) {
    const cv::Mat drawn = view.Draw(image, level);
    ASSERT_EQ(drawn.size(), image.size());
    ASSERT_EQ(drawn.type(), CV_8UC1);
    EXPECT_EQ(drawn.at<uchar>(125, 125), 0) << "on the ring, 1 / 2^" << level;
    EXPECT_EQ(drawn.at<uchar>(65, 115), 255) << "on the board, 1 / 2^" << level;
    // The last six columns have no pixel at an eighth of the resolution.
    EXPECT_EQ(drawn.at<uchar>(20, 389), 128);
  }
}

TEST(ThresholdViewTest, IgnoresNonGrayImages) {
  ThresholdView view;
  EXPECT_TRUE(view.Draw({}, 0).empty());
  EXPECT_TRUE(view.Draw(cv::Mat(64, 64, CV_8UC3, cv::Scalar(1)), 0).empty());
}

TEST(ThresholdViewTest, ImageTooSmallForTileIsUndecided) {
  const cv::Mat drawn = ThresholdView().Draw(cv::Mat(5, 6, CV_8UC1, cv::Scalar(9)), 3);
  ASSERT_EQ(drawn.size(), cv::Size(6, 5));
  EXPECT_EQ(cv::countNonZero(drawn != 128), 0);
}

}  // namespace
}  // namespace kestrel
