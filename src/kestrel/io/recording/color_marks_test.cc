// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/color_marks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

// An image 8 x 6 px: left half red, right half blue; and a mask of its right column.
class ColorMarksTest : public ::testing::Test {
 protected:
  ColorMarksTest() {
    cv::Mat image(6, 8, CV_8UC3, cv::Scalar(0, 0, 255));
    image.colRange(4, 8).setTo(cv::Scalar(255, 0, 0));
    WriteTestImage(folder_, "a.png", image);
    cv::Mat mask = cv::Mat::zeros(6, 8, CV_8UC1);
    mask.col(7).setTo(255);
    WriteTestImage(folder_, "mask.png", mask);
    WriteTestImage(folder_, "small.png", cv::Mat::zeros(2, 2, CV_8UC1));
  }

  auto Read(const std::string& yaml) const {
    return ReadMarkedColors(ParseColorMarks(yaml, folder_ / "marks.yaml"));
  }

  TestFolder folder_;
};

TEST_F(ColorMarksTest, ReadsRectanglesAndMasks) {
  const auto colors = Read(
      "- {image: a.png, color: red, rectangle: [0, 0, 3, 2]}\n"
      "- {image: a.png, color: red, rectangle: [1, 3, 1, 1]}\n"
      "- {image: a.png, color: blue, mask: mask.png}\n");
  ASSERT_EQ(colors.size(), 2u);
  EXPECT_EQ(colors.at("red").size(), 7u);
  EXPECT_EQ(colors.at("red")[0].hue_deg, 0);
  EXPECT_EQ(colors.at("blue").size(), 6u);
  EXPECT_EQ(colors.at("blue")[0].hue_deg, 240);
}

TEST_F(ColorMarksTest, RefusesMalformedMarks) {
  const auto error_of = [&](const std::string& yaml) { return InputErrorOf([&] { Read(yaml); }); };
  EXPECT_THAT(error_of("[]"), HasSubstr("no marks"));
  EXPECT_THAT(error_of("- {image: a.png, color: red}"), HasSubstr("a rectangle or a mask"));
  EXPECT_THAT(error_of("- {image: a.png, color: red, rectangle: [0, 0, 2.5, 2]}"),
              HasSubstr("whole numbers of pixels"));
  EXPECT_THAT(error_of("- {image: a.png, color: red, rectangle: [0, 0, 0, 2]}"),
              HasSubstr("empty"));
  EXPECT_THAT(error_of("- {image: a.png, color: red, rectangle: [6, 0, 3, 2]}"),
              AllOf(HasSubstr("[6, 0, 3, 2]"), HasSubstr("8 x 6 px")));
  EXPECT_THAT(error_of("- {image: a.png, color: red, mask: small.png}"), HasSubstr("2 x 2 px"));
  EXPECT_THAT(error_of("- {image: b.png, color: red, rectangle: [0, 0, 1, 1]}"),
              HasSubstr("b.png"));
}

}  // namespace
}  // namespace kestrel
