// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/open_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

std::string ErrorOf(const std::vector<std::string>& arguments) {
  return InputErrorOf([&] { OpenSource(arguments); });
}

TEST(OpenSource, RecognisesKindsOfArguments) {
  const TestFolder folder;
  const std::string a = WriteTestImage(folder, "images/a.png", cv::Mat(2, 3, CV_8UC1, 9));
  const std::string b = WriteTestImage(folder, "images/b!.png", cv::Mat(2, 3, CV_8UC1, 9));
  folder.Write("flight/cam0/data.csv", "#timestamp [ns],filename\n1,1.png\n");
  EXPECT_EQ(OpenSource({a})->frame_count(), 1u);
  EXPECT_EQ(OpenSource({b})->frame_count(), 1u);
  EXPECT_EQ(OpenSource({a, b, a})->frame_count(), 3u);
  EXPECT_EQ(OpenSource({folder / "images"})->frame_count(), 2u);
  EXPECT_EQ(OpenSource({folder / "flight"})->frame_count(), 1u);
}

TEST(OpenSource, ReportsFaultyArguments) {
  const TestFolder folder;
  const std::string image = WriteTestImage(folder, "a.png", cv::Mat(2, 3, CV_8UC1, 9));
  const std::string text = folder.Write("notes.txt", "hello");
  EXPECT_THAT(ErrorOf({}), HasSubstr("no source"));
  EXPECT_THAT(ErrorOf({folder / "none"}), HasSubstr("none: no such file or folder"));
  EXPECT_THAT(ErrorOf({text}), HasSubstr("notes.txt: by its name neither an image nor a video"));
  EXPECT_THAT(ErrorOf({image, folder / "none.png"}), HasSubstr("none.png: no such file"));
  EXPECT_THAT(ErrorOf({image, text}), HasSubstr("notes.txt: is no image"));
  EXPECT_THAT(ErrorOf({image, folder.path()}), HasSubstr(folder.path() + ": is no image"));
  EXPECT_THAT(ErrorOf({folder.Write("v.mp4", "no video")}), HasSubstr("v.mp4: cannot be opened"));
  EXPECT_THAT(ErrorOf({"/dev/video9999"}), HasSubstr("there is no /dev/video9999, "));
  EXPECT_THAT(ErrorOf({"/dev/videos"}), HasSubstr("there is no /dev/videos, "));
  EXPECT_THAT(ErrorOf({"nosuchelement ! appsink"}), HasSubstr("GStreamer: no element"));
}

}  // namespace
}  // namespace kestrel
