// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/recording_plan.h"

#include <atomic>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/codec/image_codec.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"
#include "kestrel/io/recording/test_files.h"
#include "kestrel/simulation/vehicle/flight_time.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr int kImages = 6;

// Counts the rendered images in 'rendered'.
RecordingPlan TestPlan(std::atomic<int>* rendered, const std::string& scene = "seed: 1\n") {
  RecordingPlan plan;
  for (int i = 0; i < kImages; ++i) plan.times.push_back(TimeOfFlight(0.1 * i));
  plan.render = [rendered](std::size_t i) {
    ++*rendered;
    return cv::Mat(8, 8, CV_8UC1, cv::Scalar(10.0 * static_cast<double>(i)));
  };
  plan.scene = scene;
  plan.files = {{"nav0/sensor.yaml", "sensor_type: pose\nrate_hz: 100\n"}};
  return plan;
}

bool Always(std::size_t) { return true; }

std::vector<std::string> FilesBelow(const fs::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(fs::relative(entry, folder).string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(RecordingPlanTest, WritesCompleteRecording) {
  const TestFolder folder;
  std::atomic<int> rendered = 0;
  ASSERT_TRUE(WriteRecording(TestPlan(&rendered), folder / "flight", false, 1, Always));
  EXPECT_EQ(rendered, kImages);
  const auto rows = ParseImageRows(ReadFile(folder / "flight/mav0/cam0/data.csv"), "data.csv");
  ASSERT_EQ(rows.size(), kImages);
  EXPECT_EQ(rows[1].time, TimeOfFlight(0.1));
  const cv::Mat image = ReadImage(folder / ("flight/mav0/cam0/data/" + rows[3].filename));
  EXPECT_EQ(image.at<std::uint8_t>(0, 0), 30);
  EXPECT_FALSE(fs::exists(folder / "flight.part"));
}

TEST(RecordingPlanTest, RefusesSecondWriterOfRecording) {
  const TestFolder folder;
  std::atomic<int> rendered = 0;
  const std::string output = folder / "flight";
  const auto interfere = [&](std::size_t) {
    EXPECT_THAT([&] { WriteRecording(TestPlan(&rendered, "seed: 2\n"), output, false, 1, Always); },
                ThrowsMessage<InputError>(HasSubstr("flight.part: another program")));
    return true;
  };
  ASSERT_TRUE(WriteRecording(TestPlan(&rendered), output, false, 1, interfere));
  EXPECT_EQ(rendered, kImages);
  EXPECT_EQ(ReadFile(output + "/mav0/scene.yaml"), "seed: 1\n");
}

TEST(RecordingPlanTest, InterruptedRecordingIsIncompleteAndResumed) {
  const TestFolder folder;
  std::atomic<int> rendered = 0;
  const RecordingPlan plan = TestPlan(&rendered);
  EXPECT_FALSE(
      WriteRecording(plan, folder / "flight", false, 1, [](std::size_t done) { return done < 2; }));
  EXPECT_FALSE(fs::exists(folder / "flight"));
  EXPECT_FALSE(fs::exists(folder / "flight.part/mav0/cam0/data.csv"));
  EXPECT_TRUE(WriteRecording(plan, folder / "flight", false, 1, Always));
  EXPECT_EQ(rendered, kImages) << "none twice";

  std::atomic<int> again = 0;
  EXPECT_TRUE(WriteRecording(TestPlan(&again), folder / "at_once", false, 2, Always));
  const auto files = FilesBelow(folder / "flight");
  ASSERT_EQ(files, FilesBelow(folder / "at_once"));
  for (const std::string& file : files) {
    EXPECT_EQ(ReadFile(folder / ("flight/" + file)), ReadFile(folder / ("at_once/" + file)));
  }
}

TEST(RecordingPlanTest, AnotherSceneRestartsRecording) {
  const TestFolder folder;
  std::atomic<int> rendered = 0;
  WriteRecording(TestPlan(&rendered), folder / "flight", false, 1,
                 [](std::size_t done) { return done < 3; });
  std::atomic<int> again = 0;
  EXPECT_TRUE(WriteRecording(TestPlan(&again, "seed: 2\n"), folder / "flight", false, 1, Always));
  EXPECT_EQ(again, kImages);
}

TEST(RecordingPlanTest, ReplacesOnlyRecordingsOnRequest) {
  const TestFolder folder;
  std::atomic<int> rendered = 0;
  const RecordingPlan plan = TestPlan(&rendered);
  ASSERT_TRUE(WriteRecording(plan, folder / "flight", false, 1, Always));
  const auto write = [&](const std::string& name, bool replace) {
    return InputErrorOf([&] { WriteRecording(plan, folder / name, replace, 1, Always); });
  };
  EXPECT_EQ(write("flight", false), (folder / "flight") + ": exists already; --force replaces it");
  EXPECT_EQ(write("flight", true), "");
  folder.Write("photos/holiday.txt", "mine");
  EXPECT_EQ(write("photos", true), (folder / "photos") + ": is no recording, and not empty");
  EXPECT_TRUE(fs::exists(folder / "photos/holiday.txt"));
  folder.Write("file", "text");
  EXPECT_EQ(write("file", true), (folder / "file") + ": is a file, not a folder");
  fs::create_directories(folder / "empty");
  EXPECT_EQ(write("empty", false), "");
}

TEST(RecordingPlanTest, RethrowsErrorOfThreadToCaller) {
  const TestFolder folder;
  std::atomic<int> rendered = 0;
  RecordingPlan plan = TestPlan(&rendered);
  plan.render = [](std::size_t) -> cv::Mat { throw InputError("no light"); };
  EXPECT_EQ(InputErrorOf([&] { WriteRecording(plan, folder / "flight", false, 2, Always); }),
            "no light");
  EXPECT_FALSE(fs::exists(folder / "flight"));
}

}  // namespace
}  // namespace kestrel
