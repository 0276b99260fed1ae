// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/euroc/euroc_writer.h"

#include <array>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/read_file.h"
#include "kestrel/core/codec/png_codec.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr int kWidth_px = 16;
constexpr int kHeight_px = 12;

Time At(int ms) { return Time(std::chrono::milliseconds(ms)); }

void WriteNoise(int ms, EurocWriter* writer) {
  writer->WriteImage(At(ms), "png", EncodePng(NoiseImage(kWidth_px, kHeight_px, CV_8UC1, ms)));
  writer->ListImage(At(ms), "png");
}

// A program that dies leaves what it has committed.
TEST(EurocWriter, CommittedFilesAreValidRecordingAtAnyTime) {
  const TestFolder folder;
  EurocWriter writer(folder.path(), std::array{EurocTable::kImages, EurocTable::kPoses});
  for (int i = 1; i <= 3; ++i) {
    WriteNoise(10 * i, &writer);
    writer.AddPose({At(10 * i), {}});
    writer.CommitOrThrow();
    WriteNoise(10 * i + 5, &writer);
    ImageSequence recording = OpenEurocRecording(folder.path());
    EXPECT_EQ(recording.frame_count(), 2u * i - 1) << "the newest image waits";
    EXPECT_THAT(recording.poses(), SizeIs(i));
    for (Frame frame; recording.Next(&frame);) EXPECT_EQ(frame.image.cols, kWidth_px);
  }
}

TEST(EurocWriter, CreatesOnlyFilesWithRows) {
  const TestFolder folder;
  {
    EurocWriter writer(folder.path(), std::array{EurocTable::kImages, EurocTable::kDroppedImages});
    writer.AddDroppedImage(At(1), "a reason");
  }
  EXPECT_EQ(ReadFile(folder / "mav0/cam0/dropped.csv"),
            "#timestamp [ns],reason\n1000000,a reason\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "mav0/cam0/data.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / "mav0/nav0"));
}

TEST(EurocWriter, BuffersManyRows) {
  const TestFolder folder;
  EurocWriter writer(folder.path(), std::array{EurocTable::kPoses});
  const std::string file = folder / "mav0/nav0/data.csv";
  writer.AddPose({At(0), {}});
  writer.CommitMany();
  EXPECT_FALSE(std::filesystem::exists(file)) << "one row is not many";
  for (int i = 1; i < 1000; ++i) {
    writer.AddPose({At(i), {}});
    writer.CommitMany();
  }
  EXPECT_GE(ParsePoseRows(ReadFile(file), file).size(), 300u);
}

TEST(EurocWriter, ReportsWriteFailure) {
  const TestFolder folder;
  const std::string file = folder.Write("file", "");
  EXPECT_THAT(InputErrorOf([&] { EurocWriter(file, std::array{EurocTable::kImages}); }),
              HasSubstr("file: cannot be written"));
  EurocWriter writer(folder.path(), std::array{EurocTable::kImages});
  std::filesystem::remove_all(folder / "mav0");
  EXPECT_THAT(InputErrorOf([&] { writer.WriteImage(At(1), "png", "bytes"); }),
              HasSubstr("data/1000000.png: cannot be written"));
  writer.ListImage(At(1), "png");
  EXPECT_THAT(InputErrorOf([&] { writer.CommitOrThrow(); }), HasSubstr("data.csv"));
}

}  // namespace
}  // namespace kestrel
