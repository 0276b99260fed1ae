// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/live_events.h"

#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

Time AtMs(int ms) { return Time(milliseconds(ms)); }
Frame EmptyFrame(int ms) { return {"", AtMs(ms), {}}; }
PoseSample UnitPose(int ms) { return {AtMs(ms), {}}; }

// Returns "f20" or "p10" (kind and time in ms), or "end".
std::string InWords(const Event& event) {
  if (const auto* frame = std::get_if<Frame>(&event)) {
    return "f" + std::to_string(ToNanoseconds(frame->time) / 1'000'000);
  }
  if (const auto* pose = std::get_if<PoseSample>(&event)) {
    return "p" + std::to_string(ToNanoseconds(pose->time) / 1'000'000);
  }
  return "end";
}

TEST(LiveEvents, FrameWaitsForNextPose) {
  LiveEvents events({.pose_wait_s = 1}, milliseconds(5));
  events.Push(EmptyFrame(20));
  events.Push(UnitPose(10));
  events.Push(UnitPose(24));
  EXPECT_EQ(InWords(events.Next()), "p10");
  EXPECT_EQ(InWords(events.Next()), "p24");
  std::thread autopilot([&] { events.Push(UnitPose(25)); });
  EXPECT_EQ(InWords(events.Next()), "p25") << "20 + the lead";
  EXPECT_EQ(InWords(events.Next()), "f20");
  autopilot.join();
  EXPECT_EQ(events.counters().unposed_frames, 0u);
}

TEST(LiveEvents, FrameWaitsUntilTimeout) {
  LiveEvents events({.pose_wait_s = 0.02}, Duration::zero());
  events.Push(UnitPose(10));
  const Time start = Now();
  events.Push(EmptyFrame(20));
  EXPECT_EQ(InWords(events.Next()), "p10");
  EXPECT_EQ(InWords(events.Next()), "f20");
  EXPECT_GE(Now() - start, milliseconds(20));
  EXPECT_EQ(events.counters().unposed_frames, 1u);
}

TEST(LiveEvents, FramesDoNotWaitForPosesThatDoNotCome) {
  LiveEvents events({.pose_wait_s = 1}, Duration::zero());
  const Time start = Now();
  events.Push(PoseSample{start - milliseconds(250), {}});
  events.Next();
  events.Push(Frame{"", start, {}});
  events.AwaitPoses(false);
  EXPECT_EQ(InWords(events.Next()).front(), 'f') << "it waited already";
  events.Push(Frame{"", start, {}});
  EXPECT_EQ(InWords(events.Next()).front(), 'f');
  EXPECT_LT(Now() - start, milliseconds(800));
  EXPECT_EQ(events.counters().unposed_frames, 0u);
}

// Over a slow link every pose comes 250 ms late: the test lasts as long.
TEST(LiveEvents, FrameWaitsForConstantlyLatePoses) {
  LiveEvents events({.pose_wait_s = 0.2}, Duration::zero());
  events.Push(PoseSample{Now() - milliseconds(250), {}});
  events.Next();
  const Time captured = Now();
  events.Push(Frame{"", captured, {}});
  std::thread link([&] {
    std::this_thread::sleep_for(milliseconds(250));
    events.Push(PoseSample{captured, {}});
  });
  EXPECT_EQ(InWords(events.Next()).front(), 'p');
  EXPECT_EQ(InWords(events.Next()).front(), 'f');
  link.join();
  EXPECT_EQ(events.counters().unposed_frames, 0u);
}

TEST(LiveEvents, KeepsNewestFrameWhileReaderIsBusy) {
  LiveEvents events({.pose_wait_s = 1}, Duration::zero());
  for (int ms = 0; ms < 100; ms += 10) events.Push(EmptyFrame(ms));
  events.Push(UnitPose(200));
  EXPECT_EQ(InWords(events.Next()), "p200");
  EXPECT_EQ(InWords(events.Next()), "f90");
  EXPECT_EQ(events.counters().dropped_frames, 9u);
}

// The frames of a camera that is just behind the other do not replace those of that one.
TEST(LiveEvents, KeepsNewestFrameOfEachCamera) {
  LiveEvents events({.pose_wait_s = 1}, Duration::zero(), 2);
  for (int ms = 0; ms < 80; ms += 20) {
    for (const std::size_t camera : {0, 1}) {
      Frame frame = EmptyFrame(ms + 5 * static_cast<int>(camera));
      frame.camera = camera;
      events.Push(std::move(frame));
    }
  }
  events.Push(UnitPose(200));
  for (const char* word : {"p200", "f60", "f65"}) EXPECT_EQ(InWords(events.Next()), word);
  EXPECT_EQ(events.counters().dropped_frames, 6u);
}

TEST(LiveEvents, DeliversAllFramesWhosePosesArriveTogether) {
  LiveEvents events({.pose_wait_s = 1}, Duration::zero());
  events.Push(UnitPose(-10));
  EXPECT_EQ(InWords(events.Next()), "p-10") << "the reader is there";
  for (int ms = 0; ms < 150; ms += 50) events.Push(EmptyFrame(ms));
  events.Push(UnitPose(60));
  events.Push(UnitPose(110));
  for (const char* word : {"p60", "p110", "f0", "f50", "f100"}) {
    EXPECT_EQ(InWords(events.Next()), word);
  }
  EXPECT_EQ(events.counters().dropped_frames, 0u);
  EXPECT_EQ(events.counters().unposed_frames, 0u);
}

// Otherwise poses that are later than the next frame would let no frame through.
TEST(LiveEvents, NewerFramesDoNotReplaceWaitingOne) {
  LiveEvents events({.pose_wait_s = 1}, Duration::zero());
  for (int ms = 0; ms < 200; ms += 10) events.Push(EmptyFrame(ms));
  events.Push(UnitPose(5));
  EXPECT_EQ(InWords(events.Next()), "p5");
  EXPECT_EQ(InWords(events.Next()), "f0");
  EXPECT_EQ(events.counters().dropped_frames, 10u);
  events.Push(UnitPose(195));
  EXPECT_EQ(InWords(events.Next()), "p195");
  EXPECT_EQ(InWords(events.Next()), "f190");
  EXPECT_EQ(events.counters().dropped_frames, 18u);
}

TEST(LiveEvents, EndsAtOnceWhenClosed) {
  LiveEvents events({}, Duration::zero());
  std::thread closer([&] { events.Close(); });
  EXPECT_EQ(InWords(events.Next()), "end");
  EXPECT_EQ(InWords(events.Next()), "end");
  closer.join();
}

TEST(LiveEvents, DropsOldestOfTooManyPoses) {
  LiveEvents events({}, Duration::zero());
  for (int ms = 0; ms < 300; ++ms) events.Push(UnitPose(ms));
  EXPECT_EQ(events.counters().dropped_poses, 300u - 256u);
  EXPECT_EQ(InWords(events.Next()), "p44");
}

TEST(LiveEvents, RefusesInvalidWait) {
  EXPECT_THROW(LiveEvents({.pose_wait_s = -1}, Duration::zero()), InputError);
}

}  // namespace
}  // namespace kestrel
