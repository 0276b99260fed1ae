// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/overlays/annotated_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/io/recording/media/video_source.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

TEST(AnnotatedWriter, ImagesHaveNamesOfFrames) {
  const TestFolder folder;
  const OutputFolder output(folder.path(), false);
  const auto writer = MakeImageWriter(output);
  writer->Write("cam0/7.jpg", NoiseImage(8, 6, CV_8UC3));
  writer->Write("/data/flight.mp4/000003", NoiseImage(8, 6, CV_8UC3));
  EXPECT_TRUE(std::filesystem::exists(folder / "annotated/cam0/7.png"));
  EXPECT_TRUE(std::filesystem::exists(folder / "annotated/data/flight.mp4/000003.png"));
  EXPECT_THAT(InputErrorOf([&] { writer->Write("cam0/7.jpg", NoiseImage(8, 6, CV_8UC3)); }),
              HasSubstr("exists already"));
}

TEST(AnnotatedWriter, VideoHasAllFrames) {
  const TestFolder folder;
  const OutputFolder output(folder.path(), false);
  auto writer = MakeVideoWriter(output, 0.25);
  for (int i = 0; i < 12; ++i) writer->Write("", NoiseImage(64, 48, CV_8UC3, i + 1));
  writer.reset();
  const bool is_mp4 = std::filesystem::exists(folder / "annotated.mp4");
  const auto video = OpenVideoFile(folder / (is_mp4 ? "annotated.mp4" : "annotated.avi"));
  int frames = 0;
  for (Frame frame; video->Next(&frame); ++frames) {
    EXPECT_EQ(frame.image.size(), cv::Size(64, 48));
  }
  EXPECT_EQ(frames, 12);
}

}  // namespace
}  // namespace kestrel
