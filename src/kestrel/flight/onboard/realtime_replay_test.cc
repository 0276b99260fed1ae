// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/realtime_replay.h"

#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/io/recording/euroc/euroc_recording.h"
#include "kestrel/io/recording/several_cameras.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

// Five frames from 100 s on, 20 ms apart; poses from 99 s on, 10 ms apart, x = their time.
class RealtimeReplayTest : public ::testing::Test {
 protected:
  static constexpr int kFrames = 5;

  RealtimeReplayTest() {
    std::string rows = "#timestamp [ns],filename\n";
    for (int i = 0; i < kFrames; ++i) {
      const std::string name = std::to_string(i) + ".png";
      rows += std::to_string(100'000'000'000 + 20'000'000LL * i) + "," + name + "\n";
      WriteTestImage(folder_, "mav0/cam0/data/" + name, cv::Mat(4, 4, CV_8UC1, cv::Scalar(10 * i)));
    }
    folder_.Write("mav0/cam0/data.csv", rows);
    std::string poses =
        "#timestamp [ns],p_WB_W_x [m],p_WB_W_y [m],p_WB_W_z [m],"
        "q_WB_w [],q_WB_x [],q_WB_y [],q_WB_z []\n";
    for (int i = 0; i < 120; ++i) {
      poses += std::to_string(99'000'000'000 + 10'000'000LL * i) + "," +
               std::to_string(99 + 0.01 * i) + ",0,0,1,0,0,0\n";
    }
    folder_.Write("mav0/nav0/data.csv", poses);
  }

  RealtimeReplay Replay(bool is_looped, Duration clock_offset = Duration::zero()) {
    return RealtimeReplay(
        [this] { return std::make_unique<ImageSequence>(OpenEurocRecording(folder_.path())); },
        clock_offset, is_looped);
  }

  // Waits for the next event without a limit, and returns it.
  static Event Wait(RealtimeReplay* replay) {
    for (;;) {
      if (const auto event = replay->Next(milliseconds(10))) return *event;
    }
  }

  TestFolder folder_;
};

// The stamps of the second camera are an hour ahead; its images were taken 10 ms after the first
// one's.
TEST_F(RealtimeReplayTest, CameraWithClockOfItsOwnComesInItsTurn) {
  const Duration hour = std::chrono::hours(1);
  std::string rows = "#timestamp [ns],filename\n";
  for (int i = 0; i < kFrames; ++i) {
    const std::string name = std::to_string(i) + ".png";
    rows += std::to_string(3'700'010'000'000 + 20'000'000LL * i) + "," + name + "\n";
    WriteTestImage(folder_, "mav0/cam1/data/" + name, cv::Mat(4, 4, CV_8UC1, cv::Scalar(i)));
  }
  folder_.Write("mav0/cam1/data.csv", rows);
  const std::map<std::string, Duration> clocks = {{"cam0", Duration::zero()}, {"cam1", -hour}};
  const auto open = [&] {
    std::vector<SeveralCameras::Camera> cameras;
    for (const auto& [name, offset] : clocks) {
      cameras.push_back(
          {std::make_unique<ImageSequence>(OpenEurocRecording(folder_.path(), name)), offset});
    }
    return std::make_unique<SeveralCameras>(std::move(cameras));
  };
  RealtimeReplay replay(open, Duration::zero(), false, {-hour});
  std::vector<std::size_t> cameras;
  for (;;) {
    const Event event = Wait(&replay);
    if (std::holds_alternative<EndOfStream>(event)) break;
    if (const auto* frame = std::get_if<Frame>(&event)) cameras.push_back(frame->camera);
  }
  EXPECT_EQ(cameras, (std::vector<std::size_t>{0, 1, 0, 1, 0, 1, 0, 1, 0, 1}));
}

TEST_F(RealtimeReplayTest, DeliversFramesAndPosesWhenDue) {
  RealtimeReplay replay = Replay(false);
  std::optional<Time> first_frame;
  int frames = 0;
  int poses_before = 0;
  Time last_pose;
  for (;;) {
    const Event event = Wait(&replay);
    const Time now = Now();
    if (std::holds_alternative<EndOfStream>(event)) break;
    if (const auto* pose = std::get_if<PoseSample>(&event)) {
      EXPECT_GE(now, pose->time);
      last_pose = pose->time;
      if (!first_frame) ++poses_before;
      continue;
    }
    const auto& frame = std::get<Frame>(event);
    EXPECT_GE(now, frame.time) << "no frame comes before its light";
    if (!first_frame) first_frame = frame.time;
    EXPECT_EQ(frame.time - *first_frame, milliseconds(20 * frames));
    EXPECT_EQ(frame.time - last_pose, Duration::zero()) << "poses are of the same instants";
    ++frames;
  }
  EXPECT_EQ(frames, kFrames);
  EXPECT_EQ(poses_before, 21) << "those of 200 ms, not of a second";
  EXPECT_EQ(replay.counters().captured, 5u);
}

TEST_F(RealtimeReplayTest, DeliversPoseOfFrameTimeWithFrame) {
  RealtimeReplay replay = Replay(false, milliseconds(50));
  Time newest_pose;
  for (;;) {
    const Event event = Wait(&replay);
    if (const auto* pose = std::get_if<PoseSample>(&event)) newest_pose = pose->time;
    if (const auto* frame = std::get_if<Frame>(&event)) {
      EXPECT_EQ(newest_pose - frame->time, milliseconds(50));
      return;
    }
  }
}

TEST_F(RealtimeReplayTest, LoopContinuesInTime) {
  RealtimeReplay replay = Replay(true);
  Time last_frame;
  Time last_pose;
  for (int frames = 0; frames < 3 * kFrames;) {
    const Event event = Wait(&replay);
    ASSERT_FALSE(std::holds_alternative<EndOfStream>(event));
    if (const auto* pose = std::get_if<PoseSample>(&event)) {
      EXPECT_GT(pose->time, last_pose);
      last_pose = pose->time;
    } else {
      const Time time = std::get<Frame>(event).time;
      if (frames > 0) {
        EXPECT_NEAR(ToSeconds(time - last_frame), 0.02, 0.001);
      }
      last_frame = time;
      ++frames;
    }
  }
}

// Otherwise the last frame of each round would wait for it in vain.
TEST_F(RealtimeReplayTest, DeliversPoseAfterEachFrame) {
  constexpr Duration kOffset = milliseconds(5);  // poses lie between the frames
  for (const bool is_looped : {true, false}) {
    RealtimeReplay replay = Replay(is_looped, kOffset);
    Time waiting;
    bool is_waiting = false;
    int frames = 0;
    while (frames < 3 * kFrames) {
      const Event event = Wait(&replay);
      if (std::holds_alternative<EndOfStream>(event)) break;
      if (const auto* pose = std::get_if<PoseSample>(&event)) {
        is_waiting = is_waiting && pose->time < waiting + kOffset;
        continue;
      }
      EXPECT_FALSE(is_waiting) << "frame " << frames;
      is_waiting = true;
      waiting = std::get<Frame>(event).time;
      ++frames;
    }
    EXPECT_FALSE(is_waiting && !is_looped);
    EXPECT_EQ(frames, is_looped ? 3 * kFrames : kFrames);
  }
}

TEST_F(RealtimeReplayTest, ReturnsNoEventWhenNoneIsDue) {
  RealtimeReplay replay = Replay(false);
  for (int i = 0; i < 40; ++i) replay.Next(milliseconds(1));
  const Time start = Now();
  replay.Next(milliseconds(2));
  EXPECT_LT(Now() - start, seconds(1));
}

TEST_F(RealtimeReplayTest, SkipsAndCountsBrokenImage) {
  TestFolder::CutOff(folder_ / "mav0/cam0/data/2.png", 0.5);
  RealtimeReplay replay = Replay(false);
  int frames = 0;
  for (;;) {
    const Event event = Wait(&replay);
    if (std::holds_alternative<EndOfStream>(event)) break;
    if (std::holds_alternative<Frame>(event)) ++frames;
  }
  EXPECT_EQ(frames, kFrames - 1);
  EXPECT_EQ(replay.counters().refused, 1u);
  EXPECT_EQ(replay.error(), "");
}

}  // namespace
}  // namespace kestrel
