// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/recording/video_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

constexpr int kFrames = 40;
constexpr double kRateHz = 20;

std::string WriteVideo(const TestFolder& folder) {
  std::string file = folder / "flight.avi";
  cv::VideoWriter writer(file, cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                         kRateHz, cv::Size(64, 48));
  for (int i = 0; i < kFrames; ++i) writer.write(NoiseImage(64, 48, CV_8UC3, i + 1));
  return file;
}

TEST(VideoSource, GivesEveryFrameInGrayWithItsTime) {
  const TestFolder folder;
  VideoSource source = OpenVideoFile(WriteVideo(folder));
  EXPECT_EQ(source.frame_count(), static_cast<std::size_t>(kFrames));
  EXPECT_NEAR(source.rate_hz(), kRateHz, 1e-6);
  Frame frame;
  for (int i = 0; i < kFrames; ++i) {
    ASSERT_TRUE(source.Next(&frame)) << i;
    EXPECT_EQ(frame.image.type(), CV_8UC1);
    EXPECT_NEAR(ToNanoseconds(frame.time), 1e9 * i / kRateHz, 2e6) << i;
  }
  EXPECT_EQ(frame.name, folder / "flight.avi/000039");
  EXPECT_FALSE(source.Next(&frame));
}

TEST(VideoSource, VideoThatEndsEarlyGivesItsFramesAndThenSaysSo) {
  const TestFolder folder;
  const std::string file = WriteVideo(folder);
  TestFolder::CutOff(file, 0.5);
  int frames = 0;
  const std::string error = InputErrorOf([&] {
    VideoSource source = OpenVideoFile(file);
    for (Frame frame; source.Next(&frame);) ++frames;
  });
  EXPECT_THAT(error, HasSubstr(file + ": the video ends after"));
  EXPECT_GT(frames, kFrames / 4);
  EXPECT_LT(frames, kFrames);
}

TEST(VideoSource, FileWithoutVideoIsRefused) {
  const TestFolder folder;
  EXPECT_NE(InputErrorOf([&] { OpenVideoFile(folder.Write("a.mp4", "")); }), "");
  EXPECT_NE(InputErrorOf([&] { OpenVideoFile(folder.Write("b.avi", "RIFF")); }), "");
}

}  // namespace
}  // namespace kestrel
