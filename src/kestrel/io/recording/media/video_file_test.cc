// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/video_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/io/recording/media/video_source.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

void ExpectVideo(const std::string& path, std::size_t count, double rate_hz) {
  const auto video = OpenVideoFile(path);
  EXPECT_NEAR(video->rate_hz(), rate_hz, 0.01);
  std::size_t frames = 0;
  for (Frame frame; video->Next(&frame); ++frames) {
    EXPECT_EQ(frame.image.size(), cv::Size(64, 48));
  }
  EXPECT_EQ(frames, count);
}

TEST(VideoFileTest, HasImagesAtItsRate) {
  const TestFolder folder;
  VideoFile file(folder / "clip", 12.5);
  EXPECT_EQ(file.path(), "");
  for (int i = 0; i < 5; ++i) file.Write(NoiseImage(64, 48, CV_8UC3, i + 1));
  file.Close();
  EXPECT_EQ(file.path(), folder / "clip.mp4");
  ExpectVideo(file.path(), 5, 12.5);
}

TEST(VideoFileTest, WritesAviOnRequest) {
  const TestFolder folder;
  const std::string path =
      WriteTestVideo(folder / "clip", VideoFormat::kAvi, 5, {64, 48}, /*rate_hz=*/12.5);
  EXPECT_EQ(path, folder / "clip.avi");
  ExpectVideo(path, 5, 12.5);
}

TEST(VideoFileTest, IsCompleteWithoutClose) {
  const TestFolder folder;
  {
    VideoFile file(folder / "clip", 10);
    for (int i = 0; i < 3; ++i) file.Write(NoiseImage(64, 48, CV_8UC3, i + 1));
  }
  ExpectVideo(folder / "clip.mp4", 3, 10);
}

TEST(VideoFileTest, RefusesImagesOfDifferentSizes) {
  const TestFolder folder;
  VideoFile file(folder / "clip", 10);
  file.Write(NoiseImage(64, 48, CV_8UC3));
  EXPECT_THAT(InputErrorOf([&] { file.Write(NoiseImage(48, 64, CV_8UC3)); }),
              HasSubstr("images of one size"));
}

TEST(VideoFileTest, ReportsUnwritablePath) {
  const TestFolder folder;
  VideoFile file(folder / "missing/clip", 10);
  EXPECT_THAT(InputErrorOf([&] { file.Write(NoiseImage(64, 48, CV_8UC3)); }),
              HasSubstr("cannot be written"));
  std::filesystem::create_directories(folder / "taken.mp4");
  VideoFile taken(folder / "taken", 10);
  EXPECT_THAT(InputErrorOf([&] {
                taken.Write(NoiseImage(64, 48, CV_8UC3));
                taken.Close();
              }),
              HasSubstr("taken.mp4: cannot be written: "));
}

}  // namespace
}  // namespace kestrel
