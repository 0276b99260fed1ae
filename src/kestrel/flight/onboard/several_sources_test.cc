// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/several_sources.h"

#include <chrono>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

using std::chrono::milliseconds;

// Gives out some frames, then ends, or hangs for longer than a reader waits.
class ScriptedSource : public LiveSource {
 public:
  ScriptedSource(int frames, Duration period, bool ends)
      : frames_(frames), period_(period), ends_(ends) {}

  std::optional<Event> Next(Duration timeout) override {
    if (given_ == frames_) {
      if (ends_) return Event(EndOfStream{});
      std::this_thread::sleep_for(timeout);
      return std::nullopt;
    }
    std::this_thread::sleep_for(period_);
    ++given_;
    return Event(Frame{"", Now(), {}});
  }
  std::string error() const override { return !ends_ && given_ == frames_ ? "is gone" : ""; }
  CaptureCounters counters() const override {
    return {.captured = static_cast<std::uint64_t>(given_)};
  }

 private:
  const int frames_;
  const Duration period_;
  const bool ends_;
  std::atomic<int> given_{0};
};

SeveralSources::Camera Scripted(const char* name, int frames, Duration period, bool ends) {
  return {name, std::make_unique<ScriptedSource>(frames, period, ends)};
}

// Counts the frames of each camera up to the end, or for half a second.
std::vector<int> Count(SeveralSources* sources) {
  std::vector<int> counts(2);
  const Time until = Now() + milliseconds(500);
  while (Now() < until) {
    const auto event = sources->Next(milliseconds(10));
    if (!event) continue;
    if (std::holds_alternative<EndOfStream>(*event)) return counts;
    ++counts[std::get<Frame>(*event).camera];
  }
  return counts;
}

TEST(SeveralSourcesTest, GivesTheFramesOfAllUntilTheLastHasEnded) {
  std::vector<SeveralSources::Camera> cameras;
  cameras.push_back(Scripted("cam0", 5, milliseconds(2), true));
  cameras.push_back(Scripted("cam1", 12, milliseconds(3), true));
  SeveralSources sources(std::move(cameras));
  EXPECT_EQ(Count(&sources), (std::vector{5, 12}));
  EXPECT_EQ(sources.counters().captured, 17u);
}

TEST(SeveralSourcesTest, OneThatIsGoneIsNamedAndDoesNotDelayTheOther) {
  std::vector<SeveralSources::Camera> cameras;
  cameras.push_back(Scripted("cam0", 1, milliseconds(1), false));
  cameras.push_back(Scripted("cam1", 1000, milliseconds(5), false));
  SeveralSources sources(std::move(cameras));
  const std::vector<int> counts = Count(&sources);
  EXPECT_EQ(counts[0], 1);
  EXPECT_GT(counts[1], 20);
  EXPECT_EQ(sources.error(), "cam0: is gone");
}

}  // namespace
}  // namespace kestrel
