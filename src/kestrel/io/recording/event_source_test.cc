// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/event_source.h"

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

Time Ms(int ms) { return Time(std::chrono::milliseconds(ms)); }

// Empty frames at given times.
class TimedFrames : public FrameSource {
 public:
  explicit TimedFrames(std::vector<int> times_ms) : times_ms_(std::move(times_ms)) {}
  bool ReadNext(Frame* frame) override {
    if (next_ == times_ms_.size()) return false;
    frame->time = Ms(times_ms_[next_++]);
    return true;
  }
  std::optional<std::size_t> frame_count() const override { return times_ms_.size(); }
  double rate_hz() const override { return 1; }

 private:
  std::vector<int> times_ms_;
  std::size_t next_ = 0;
};

// Returns the events as text: "p1" for a pose at 1 ms, "f2" for a frame at 2 ms.
std::string EventsOf(std::vector<int> frames_ms, const std::vector<int>& poses_ms, int lead_ms) {
  TimedFrames frames(std::move(frames_ms));
  std::vector<PoseSample> poses;
  for (const int time : poses_ms) poses.push_back({Ms(time), {}});
  RecordingEvents events(&frames, poses, std::chrono::milliseconds(lead_ms));
  std::string words;
  for (;;) {
    const Event event = events.Next();
    if (std::holds_alternative<EndOfStream>(event)) return words;
    const auto* pose = std::get_if<PoseSample>(&event);
    const Time time = pose != nullptr ? pose->time : std::get<Frame>(event).time;
    words += fmt::format("{}{} ", pose != nullptr ? 'p' : 'f', ToNanoseconds(time) / 1'000'000);
  }
}

TEST(RecordingEvents, FrameComesAfterItsNextPose) {
  EXPECT_EQ(EventsOf({15, 30, 31}, {0, 10, 20, 30, 40}, 0), "p0 p10 p20 f15 p30 f30 p40 f31 ");
}

TEST(RecordingEvents, AddsLeadToFrameTime) {
  EXPECT_EQ(EventsOf({15}, {0, 10, 20, 30, 40}, 10), "p0 p10 p20 p30 f15 ");
  EXPECT_EQ(EventsOf({15}, {0, 10, 20, 30, 40}, -10), "p0 p10 f15 ");
}

TEST(RecordingEvents, DeliversFramesWithoutPoses) {
  EXPECT_EQ(EventsOf({1, 2}, {}, 0), "f1 f2 ");
  EXPECT_EQ(EventsOf({1, 2, 30}, {0}, 0), "p0 f1 f2 f30 ");
  EXPECT_EQ(EventsOf({}, {0, 1}, 0), "");
}

}  // namespace
}  // namespace kestrel
