// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/color_training/color_stroke.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

cv::Mat GrayImage() { return {60, 80, CV_8UC3, cv::Scalar(100, 100, 100)}; }

TEST(StrokeMask, RectangleTakesCornersInAnyOrder) {
  const ColorStroke stroke{0, "red", StrokeTool::kRectangle, 0, {{20, 12}, {11, 10}}};
  const cv::Mat mask = StrokeMask(stroke, GrayImage());
  EXPECT_EQ(cv::countNonZero(mask), 10 * 3);
  EXPECT_EQ(mask.at<uchar>(10, 11), 255);
  EXPECT_EQ(mask.at<uchar>(12, 20), 255);
  EXPECT_EQ(mask.at<uchar>(13, 20), 0);
}

TEST(StrokeMask, BrushIsRoundAndWithoutGaps) {
  const ColorStroke stroke{0, "red", StrokeTool::kBrush, 3, {{20, 30}, {60, 30}}};
  const cv::Mat mask = StrokeMask(stroke, GrayImage());
  for (int u = 20; u <= 60; ++u) {
    EXPECT_EQ(mask.at<uchar>(33, u), 255);
    EXPECT_EQ(mask.at<uchar>(35, u), 0);
  }
  EXPECT_EQ(mask.at<uchar>(30, 17), 255);
  EXPECT_EQ(mask.at<uchar>(33, 17), 0) << "the corner";
}

TEST(StrokeMask, GrowsOverConnectedPixelsOfSameColour) {
  cv::Mat image = GrayImage();
  image(cv::Rect(10, 10, 20, 20)).setTo(cv::Scalar(20, 20, 200));
  image(cv::Rect(12, 12, 5, 5)).setTo(cv::Scalar(25, 22, 210));
  image(cv::Rect(50, 10, 5, 5)).setTo(cv::Scalar(20, 20, 200));
  const cv::Mat before = image.clone();
  const ColorStroke stroke{0, "red", StrokeTool::kGrow, 15, {{25, 25}}};
  const cv::Mat mask = StrokeMask(stroke, image);
  EXPECT_EQ(cv::countNonZero(mask), 400);
  EXPECT_EQ(mask.at<uchar>(12, 52), 0) << "as red, but not joined";
  EXPECT_EQ(cv::norm(image, before), 0) << "the image is as it was";
}

TEST(StrokeMask, RefusesPointsOutsideImage) {
  const ColorStroke stroke{7, "red", StrokeTool::kGrow, 15, {{80, 25}}};
  try {
    StrokeMask(stroke, GrayImage());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("frame 7: the point [80, 25]"));
  }
}

TEST(ColorStroke, ValidatesInputOfEachTool) {
  EXPECT_THAT(ColorStroke({0, "", StrokeTool::kBrush, 5, {{1, 1}}}).Validate(), IsEmpty());
  EXPECT_THAT(ColorStroke({0, "", StrokeTool::kBrush, 0, {{1, 1}}}).Validate(),
              Contains(HasSubstr("brush's size")));
  EXPECT_THAT(ColorStroke({0, "", StrokeTool::kBrush, 5, {}}).Validate(),
              Contains(HasSubstr("1 to 1000 points")));
  EXPECT_THAT(ColorStroke({0, "", StrokeTool::kRectangle, 0, {{1, 1}}}).Validate(),
              Contains(HasSubstr("two points")));
  EXPECT_THAT(ColorStroke({0, "", StrokeTool::kGrow, 101, {{1, 1}}}).Validate(),
              Contains(HasSubstr("1 to 100")));
}

}  // namespace
}  // namespace kestrel
