// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/video_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/io/recording/media/gstreamer.h"
#include "kestrel/io/recording/media/image_file.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

constexpr int kFrames = 40;
constexpr double kRateHz = 20;

std::string WriteVideo(const TestFolder& folder, VideoFormat format) {
  return WriteTestVideo(folder / "flight", format, kFrames, {64, 48}, kRateHz);
}

TEST(VideoSource, ReadsEveryFrameInGrayWithTime) {
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

TEST(VideoSource, ReadsColorsUnchanged) {
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

TEST(VideoSource, KeepsColorsAlongWithGray) {
  const TestFolder folder;
  const auto source = OpenVideoFile(WriteVideo(folder, VideoFormat::kAvi));
  source->set_keeps_color(true);
  Frame frame;
  ASSERT_TRUE(source->Next(&frame));
  ASSERT_EQ(frame.color.type(), CV_8UC3);
  EXPECT_EQ(cv::norm(ToFormat(frame.color, PixelFormat::kGray, ""), frame.image, cv::NORM_INF), 0);
}

TEST(VideoSource, ReportsTruncatedVideoAfterItsFrames) {
  const TestFolder folder;
  const std::string file = WriteVideo(folder, VideoFormat::kAvi);
  TestFolder::CutOff(file, 0.5);
  int frames = 0;
  const std::string error = InputErrorOf([&] {
    const auto source = OpenVideoFile(file);
    for (Frame frame; source->Next(&frame);) ++frames;
  });
  EXPECT_THAT(error, HasSubstr(file + ": the video is cut off after"));
  EXPECT_GT(frames, kFrames / 4);
  EXPECT_LT(frames, kFrames);
}

TEST(VideoSource, RefusesFileWithoutVideo) {
  const TestFolder folder;
  const std::string cut = WriteVideo(folder, VideoFormat::kMp4);
  TestFolder::CutOff(cut, 0.5);
  for (const std::string& file : {folder.Write("a.mp4", ""), folder.Write("b.avi", "RIFF"), cut}) {
    const std::string error = InputErrorOf([&] { OpenVideoFile(file); });
    EXPECT_THAT(error, HasSubstr(file + ": cannot be opened as a video: "));
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

TEST(VideoSource, OpensPipelineAsCamera) {
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

TEST(VideoSource, ReportsMissingCamera) {
  EXPECT_THAT(InputErrorOf([] { OpenCamera("/dev/video77"); }),
              HasSubstr("there is no /dev/video77, "));
  EXPECT_THAT(InputErrorOf([] { OpenCamera("nothing ! fakesink"); }),
              HasSubstr("nothing ! fakesink: GStreamer: "));
}

// Runs a pipeline of GStreamer that writes a file.
void MakeFile(const std::string& pipeline) {
  const GstElementPointer running = ParsePipeline(pipeline, "test");
  gst_element_set_state(running.get(), GST_STATE_PLAYING);
  const GstBusPointer bus(gst_element_get_bus(running.get()));
  const GstMessagePointer end(gst_bus_timed_pop_filtered(
      bus.get(), 20 * GST_SECOND, GstMessageType(GST_MESSAGE_EOS | GST_MESSAGE_ERROR)));
  ASSERT_TRUE(end && GST_MESSAGE_TYPE(end.get()) == GST_MESSAGE_EOS) << pipeline;
  gst_element_set_state(running.get(), GST_STATE_NULL);
}

std::size_t FramesOf(const std::string& file) {
  const auto source = OpenVideoFile(file);
  std::size_t frames = 0;
  for (Frame frame; source->Next(&frame);) ++frames;
  return frames;
}

// As a phone in the dusk, and as a segment of a longer recording.
TEST(VideoSource, ReadsVariableRateAndLateStartCompletely) {
  const TestFolder folder;
  const std::string picture = "videotestsrc num-buffers=24 ! video/x-raw,width=64,height=48,";
  const std::string late = " ! identity ts-offset=60000000000 ! jpegenc ! ";
  for (const std::string muxer : {"matroskamux", "qtmux", "avimux"}) {
    const std::string file = folder / muxer;
    const std::string sink = muxer + " ! filesink location=" + file;
    MakeFile(picture + "framerate=15/1 ! jpegenc ! " + sink);
    EXPECT_EQ(FramesOf(file), 24u) << muxer;
    MakeFile(picture + "framerate=30/1" + late + sink);
    EXPECT_EQ(FramesOf(file), 24u) << muxer << ", late";
    TestFolder::CutOff(file, 0.98);
    EXPECT_THAT(InputErrorOf([&] { FramesOf(file); }), HasSubstr(file)) << muxer << ", cut";
  }
  // The container declares 30 frames a second; a third of them is missing.
  const std::string file = folder / "changes.mkv";
  MakeFile(picture + "framerate=30/1 ! jpegenc ! identity drop-probability=0.3 ! matroskamux ! " +
           "filesink location=" + file);
  EXPECT_GT(FramesOf(file), 0u);
}

TEST(VideoSource, ReportsFileWithSoundOnly) {
  const TestFolder folder;
  for (const std::string muxer : {"matroskamux", "qtmux", "avimux"}) {
    const std::string file = folder / muxer;
    MakeFile("audiotestsrc num-buffers=20 ! audio/x-raw,rate=8000 ! " + muxer +
             " ! filesink location=" + file);
    EXPECT_EQ(InputErrorOf([&] { OpenVideoFile(file); }), file + ": has no pictures, only sound");
  }
}

}  // namespace
}  // namespace kestrel
