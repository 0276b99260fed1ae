// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/colors/kept_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class KeptFramesTest : public testing::Test {
 protected:
  static cv::Mat Image(int value) { return {6, 8, CV_8UC3, cv::Scalar(value, 200, 255 - value)}; }
  std::string Refusal(const cv::Mat& image) {
    try {
      kept_.Keep(image, Time{});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  const TestFolder test_folder_;
  const fs::path folder_ = test_folder_ / "kept";
  KeptFrames kept_{folder_};
};

TEST_F(KeptFramesTest, KeepsFramesLosslesslyInOrder) {
  EXPECT_FALSE(fs::exists(folder_)) << "nothing is kept yet";
  const std::string reported = kept_.Keep(Image(3), TimeFromNanoseconds(77));
  EXPECT_THAT(reported, HasSubstr("frame 1 is kept as "));
  EXPECT_TRUE(fs::exists(folder_ / "01_77.png"));
  kept_.Keep(Image(4), TimeFromNanoseconds(12));  // a camera's clock may be set back
  EXPECT_EQ(cv::norm(kept_.Read(0), Image(3), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(kept_.Read(1), Image(4), cv::NORM_INF), 0);
  fs::remove(folder_ / "01_77.png");
  EXPECT_THROW(kept_.Read(0), InputError);
}

TEST_F(KeptFramesTest, RefusesFrameBeyondLimitAndReplacesNone) {
  for (std::size_t i = 0; i < KeptFrames::kMost; ++i) {
    kept_.Keep(Image(static_cast<int>(i)), TimeFromNanoseconds(5));
  }
  EXPECT_THAT(Refusal(Image(99)), HasSubstr("32 frames are kept, there is no room for more"));
  EXPECT_EQ(cv::norm(kept_.Read(0), Image(0), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(kept_.Read(31), Image(31), cv::NORM_INF), 0);
}

TEST_F(KeptFramesTest, RefusesEmptyAndGrayImages) {
  EXPECT_THAT(Refusal({}), HasSubstr("there is no image yet"));
  EXPECT_THAT(Refusal(cv::Mat(4, 4, CV_8UC1, cv::Scalar(1))), HasSubstr("has no colour"));
  EXPECT_FALSE(fs::exists(folder_));
}

}  // namespace
}  // namespace kestrel
