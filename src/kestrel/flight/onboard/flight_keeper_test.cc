// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/flight_keeper.h"

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/codec/image_codec.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::StartsWith;

CameraCalibration SmallCamera() {
  CameraCalibration calibration;
  calibration.intrinsics = {.width_px = 64,
                            .height_px = 48,
                            .fx_px = 60,
                            .fy_px = 60,
                            .cx_px = 32,
                            .cy_px = 24,
                            .distortion = {}};
  calibration.body_from_camera = RigidTransform{};
  return calibration;
}

Frame NoiseFrame(int ms) {
  return {"", Time(seconds(1000) + milliseconds(ms)), NoiseImage(64, 48, CV_8UC1, ms + 1)};
}

class FlightKeeperTest : public ::testing::Test {
 protected:
  FlightKeeperTest() { options_.free_space_mb = 0; }

  // Returns the kept folders and files.
  std::vector<fs::path> Kept() const {
    const std::string folder = folder_ / "kept";
    return {fs::directory_iterator(folder), fs::directory_iterator()};
  }

  TestFolder folder_;
  FlightRecorderOptions options_;
  RecordingSwitch recording_{[this](const fs::path& folder, bool replace) {
    return std::make_unique<FlightRecorder>(folder, replace, SmallCamera(), 50, options_,
                                            FlightRecorder::Notify());
  }};
  FlightKeeper keeper_{folder_ / "kept", &recording_};
};

TEST_F(FlightKeeperTest, StartsAndStopsRecording) {
  EXPECT_EQ(keeper_.StopRecording(), "no recording is on");
  EXPECT_EQ(recording_.Get(), nullptr);
  for (int round = 0; round < 2; ++round) {  // each has a folder of its own, even within one second
    EXPECT_THAT(keeper_.StartRecording(), StartsWith("recording into "));
    EXPECT_EQ(keeper_.StartRecording(), "a recording is on already");
    for (int i = 0; i < 5; ++i) recording_.Get()->AddFrame(NoiseFrame(20 * i));
    EXPECT_EQ(keeper_.StopRecording(), "the recording is written");
    EXPECT_EQ(recording_.Get(), nullptr);
  }
  ASSERT_EQ(Kept().size(), 2u);
  for (const fs::path& kept : Kept()) {
    EXPECT_GT(OpenEurocRecording(kept.string()).frame_count().value_or(0), 0u);
  }
}

TEST_F(FlightKeeperTest, StartsAndStopsWhileFramesArrive) {
  std::atomic<bool> is_over{false};
  std::thread camera([&] {
    for (int ms = 0; !is_over; ++ms) {
      if (const auto recorder = recording_.Get()) recorder->AddFrame(NoiseFrame(ms));
      std::this_thread::yield();
    }
  });
  for (int i = 0; i < 10; ++i) {
    keeper_.StartRecording();
    while (recording_.Get()->counters().images == 0) std::this_thread::yield();
    keeper_.StopRecording();
  }
  is_over = true;
  camera.join();
  EXPECT_EQ(Kept().size(), 10u);
  recording_.Close();
  EXPECT_THAT(keeper_.StartRecording(), HasSubstr("the flight ends"));
}

TEST_F(FlightKeeperTest, SnapshotsReplaceNothing) {
  const Frame frame = NoiseFrame(7);
  const std::string reported = keeper_.KeepSnapshot(frame.image, frame.time);
  EXPECT_THAT(reported, HasSubstr("snapshot_1000007000000.png"));
  EXPECT_THAT(keeper_.KeepSnapshot(frame.image, frame.time), HasSubstr("-2.png"));
  for (const fs::path& kept : Kept()) {
    const cv::Mat image = ReadImage(kept.string());
    EXPECT_EQ(cv::norm(image, frame.image, cv::NORM_INF), 0);
  }
}

TEST_F(FlightKeeperTest, ReportsFolderThatCannotBeCreated) {
  FlightKeeper keeper(folder_.Write("file", "") + "/below", &recording_);
  EXPECT_THROW(keeper.StartRecording(), InputError);
  EXPECT_THROW(keeper.KeepSnapshot(NoiseFrame(0).image, NoiseFrame(0).time), InputError);
  EXPECT_EQ(recording_.Get(), nullptr);
}

}  // namespace
}  // namespace kestrel
