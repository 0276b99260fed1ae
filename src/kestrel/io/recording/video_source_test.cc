// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/video_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/io/recording/image_file.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

constexpr int kFrames = 40;
constexpr double kRateHz = 20;

std::string WriteVideo(const TestFolder& folder, VideoFormat format) {
  return WriteTestVideo(folder / "flight", format, kFrames, {64, 48}, kRateHz);
}

TEST(VideoSource, GivesEveryFrameInGrayWithItsTime) {
  const TestFolder folder;
  for (const VideoFormat format : {VideoFormat::kAvi, VideoFormat::kMp4}) {
    const std::string file = WriteVideo(folder, format);
    const auto source = OpenVideoFile(file);
    EXPECT_EQ(source->frame_count(), static_cast<std::size_t>(kFrames)) << file;
    EXPECT_NEAR(source->rate_hz(), kRateHz, 1e-6) << file;
    Frame frame;
    for (int i = 0; i < kFrames; ++i) {
      ASSERT_TRUE(source->Next(&frame)) << file << i;
      EXPECT_EQ(frame.image.type(), CV_8UC1);
      EXPECT_NEAR(ToNanoseconds(frame.time), 1e9 * i / kRateHz, 2e6) << file << i;
    }
    EXPECT_EQ(frame.name, file + "/000039");
    EXPECT_FALSE(source->Next(&frame));
  }
}

TEST(VideoSource, GivesColorsAsTheyWere) {
  const TestFolder folder;
  const cv::Scalar colors[] = {{20, 30, 200}, {200, 40, 20}, {0, 0, 0}, {255, 255, 255}};
  for (const VideoFormat format : {VideoFormat::kAvi, VideoFormat::kMp4}) {
    VideoFile file(folder / "colors", kRateHz, format);
    for (const cv::Scalar& color : colors) file.Write(cv::Mat(48, 64, CV_8UC3, color));
    file.Close();
    const auto source = OpenVideoFile(file.path());
    source->set_format(PixelFormat::kBgr);
    for (const cv::Scalar& color : colors) {
      Frame frame;
      ASSERT_TRUE(source->Next(&frame));
      ASSERT_EQ(frame.image.type(), CV_8UC3);
      EXPECT_LT(cv::norm(cv::mean(frame.image) - color, cv::NORM_INF), 6) << file.path() << color;
      EXPECT_TRUE(frame.color.empty());
    }
  }
}

TEST(VideoSource, KeepsTheColorsBesideTheGray) {
  const TestFolder folder;
  const auto source = OpenVideoFile(WriteVideo(folder, VideoFormat::kAvi));
  source->set_keeps_color(true);
  Frame frame;
  ASSERT_TRUE(source->Next(&frame));
  ASSERT_EQ(frame.color.type(), CV_8UC3);
  EXPECT_EQ(cv::norm(ToFormat(frame.color, PixelFormat::kGray, ""), frame.image, cv::NORM_INF), 0);
}

TEST(VideoSource, VideoThatEndsEarlyGivesItsFramesAndThenSaysSo) {
  const TestFolder folder;
  const std::string file = WriteVideo(folder, VideoFormat::kAvi);
  TestFolder::CutOff(file, 0.5);
  int frames = 0;
  const std::string error = InputErrorOf([&] {
    const auto source = OpenVideoFile(file);
    for (Frame frame; source->Next(&frame);) ++frames;
  });
  EXPECT_THAT(error, HasSubstr(file + ": the video ends after"));
  EXPECT_GT(frames, kFrames / 4);
  EXPECT_LT(frames, kFrames);
}

TEST(VideoSource, FileWithoutVideoIsRefused) {
  const TestFolder folder;
  const std::string cut = WriteVideo(folder, VideoFormat::kMp4);
  TestFolder::CutOff(cut, 0.5);
  for (const std::string& file : {folder.Write("a.mp4", ""), folder.Write("b.avi", "RIFF"), cut}) {
    const std::string error = InputErrorOf([&] { OpenVideoFile(file); });
    EXPECT_THAT(error, HasSubstr(file + ": cannot be opened as a video: "));
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

TEST(VideoSource, APipelineIsACamera) {
  const auto source = OpenCamera(
      "videotestsrc num-buffers=5 pattern=white ! video/x-raw,width=64,height=48,framerate=25/1");
  EXPECT_FALSE(source->frame_count());
  EXPECT_NEAR(source->rate_hz(), 25, 1e-6);
  Frame frame;
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(source->Next(&frame)) << i;
    EXPECT_EQ(ToNanoseconds(frame.time), 40'000'000 * i);
    EXPECT_EQ(frame.image.size(), cv::Size(64, 48));
  }
  EXPECT_EQ(frame.name, "gstreamer/000004");
  EXPECT_FALSE(source->Next(&frame));
}

TEST(VideoSource, ACameraThatIsNotThereIsNamed) {
  EXPECT_THAT(InputErrorOf([] { OpenCamera("/dev/video77"); }),
              HasSubstr("/dev/video77: no such camera, or in use"));
  EXPECT_THAT(InputErrorOf([] { OpenCamera("nothing ! fakesink"); }),
              HasSubstr("nothing ! fakesink: GStreamer: "));
}

}  // namespace
}  // namespace kestrel
