// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/recording/video_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

TEST(VideoFileTest, HasItsImagesAtItsRate) {
  const TestFolder folder;
  VideoFile file(folder / "clip", 12.5);
  EXPECT_EQ(file.path(), "");
  for (int i = 0; i < 5; ++i) file.Write(NoiseImage(64, 48, CV_8UC3, i + 1));
  file.Close();
  EXPECT_THAT(file.path(), HasSubstr(folder / "clip."));
  cv::VideoCapture video(file.path());
  EXPECT_NEAR(video.get(cv::CAP_PROP_FPS), 12.5, 0.01);
  int frames = 0;
  for (cv::Mat image; video.read(image); ++frames) EXPECT_EQ(image.size(), cv::Size(64, 48));
  EXPECT_EQ(frames, 5);
}

TEST(VideoFileTest, ImagesHaveOneSize) {
  const TestFolder folder;
  VideoFile file(folder / "clip", 10);
  file.Write(NoiseImage(64, 48, CV_8UC3));
  EXPECT_THAT(InputErrorOf([&] { file.Write(NoiseImage(48, 64, CV_8UC3)); }),
              HasSubstr("images of one size"));
}

TEST(VideoFileTest, WhereItCannotBeIsSaid) {
  const TestFolder folder;
  VideoFile file(folder / "missing/clip", 10);
  EXPECT_THAT(InputErrorOf([&] { file.Write(NoiseImage(64, 48, CV_8UC3)); }),
              HasSubstr("cannot be written"));
}

}  // namespace
}  // namespace kestrel
