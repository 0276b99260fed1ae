// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/console/replay_console.h"

#include <atomic>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/base/error.h"
#include "kestrel/camera/paper_camera.h"
#include "kestrel/console/test_browser.h"

namespace kestrel {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kFrames = 20;

// One frame every 100 ms.
std::vector<ReplayFrame> Frames() {
  std::vector<ReplayFrame> frames(kFrames);
  for (std::size_t i = 0; i < kFrames; ++i) {
    frames[i].observation.time = Time(1000s + i * 100ms);
    frames[i].error_px = static_cast<double>(i);
  }
  return frames;
}

void Detect(ReplayFrame* frame) { frame->observation.report.detection.emplace(); }

std::string Marks(const std::vector<ReplayFrame>& frames) {
  std::string marks;
  for (const ReplayFrame& frame : frames) marks += "-flx"[static_cast<int>(frame.mark)];
  return marks;
}

TEST(MarkByTrackTest, LostIsBetweenFoundAndFalseWhatTheTrackDoesNotTake) {
  std::vector<ReplayFrame> frames = Frames();
  for (const int i : {3, 4, 6, 9}) Detect(&frames[i]);
  frames[6].observation.fate = MeasurementFate::kFarFromTrack;
  MarkByTrack(&frames);
  EXPECT_EQ(Marks(frames), "---fflxllf----------");
  std::vector<ReplayFrame> nothing = Frames();
  MarkByTrack(&nothing);
  EXPECT_EQ(Marks(nothing), std::string(kFrames, '-'));
}

class ReplayConsoleTest : public testing::Test {
 protected:
  static ConsoleOptions FreePort() {
    ConsoleOptions options;
    options.port = 0;
    return options;
  }
  ReplayConsoleTest() {
    thread_ = std::thread([this] {
      console_.Play(
          Frames(),
          [this](std::size_t frame) {
            if (frame == missing_) throw InputError("frame7.png: no such file");
            read_ = frame;
            return cv::Mat(240, 376, CV_8UC1, cv::Scalar(static_cast<double>(frame)));
          },
          [this] { return is_stopped_.load(); });
    });
  }
  ~ReplayConsoleTest() override {
    is_stopped_ = true;
    thread_.join();
  }
  int port() const {
    const std::string url = console_.url();
    return std::stoi(url.substr(url.rfind(':') + 1));
  }
  // Reads until the page is told that it is at this frame with this speed; false when it is not.
  static bool IsTold(TestSocket* socket, std::size_t frame, double speed) {
    while (const auto playback = socket->Next("playback")) {
      if ((*playback)["frame"] == frame && (*playback)["speed"] == speed) return true;
    }
    return false;
  }

  std::atomic<std::size_t> missing_{99};
  std::atomic<bool> is_stopped_{false};
  std::atomic<std::size_t> read_{99};
  ReplayConsole console_{FreePort(), "a recording",
                         LandingView{CameraModel(PaperCamera()), {}, TurnNoise()}, true};
  std::thread thread_;
};

TEST_F(ReplayConsoleTest, SeeksStepsAndPlays) {
  TestSocket socket(port());
  const auto timeline = socket.Next("timeline");
  ASSERT_TRUE(timeline);
  EXPECT_EQ((*timeline)["times_ms"].size(), kFrames);
  socket.Send(R"({"command": "seek", "value": 0.52})");
  EXPECT_TRUE(IsTold(&socket, 5, 0));
  EXPECT_EQ(read_, 5U);
  socket.Send(R"({"command": "step", "value": -1})");
  EXPECT_TRUE(IsTold(&socket, 4, 0));
  socket.Send(R"({"command": "seek", "value": -1e300})");
  EXPECT_TRUE(IsTold(&socket, 0, 0));
  socket.Send(R"({"command": "step", "value": 1e300})");
  EXPECT_TRUE(IsTold(&socket, kFrames - 1, 0));
  // From the end it plays from the beginning, and holds at the end.
  socket.Send(R"({"command": "play", "value": 0.001})");
  EXPECT_TRUE(IsTold(&socket, 0, 0.001));
  socket.Send(R"({"command": "play", "value": 10})");
  EXPECT_TRUE(IsTold(&socket, kFrames - 1, 0));
  socket.Send(R"({"command": "play", "value": -20})");
  EXPECT_TRUE(IsTold(&socket, 0, 0));
}

TEST_F(ReplayConsoleTest, AFrameWhoseFileIsGoneIsSaid) {
  missing_ = 7;
  TestSocket socket(port());
  socket.Send(R"({"command": "seek", "value": 0.7})");
  const auto event = socket.Next("event");
  ASSERT_TRUE(event);
  EXPECT_EQ((*event)["text"], "frame7.png: no such file");
  socket.Send(R"({"images": true})");
  socket.Send(R"({"command": "step", "value": 1})");
  EXPECT_TRUE(IsTold(&socket, 8, 0));
}

}  // namespace
}  // namespace kestrel
