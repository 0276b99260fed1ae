// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/asynchronous_sink.h"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/flight/session/observation_sinks.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;

// Records what a writer receives, and has a gate that holds the writer up.
struct Written {
  std::mutex mutex;
  std::condition_variable changed;
  bool is_held = false;
  std::atomic<bool> is_wanted{true};
  std::vector<int> frames;
  std::vector<std::string> events;
  int reports = 0, team_reports = 0;
  std::size_t dropped = 0;
  int finished = 0;
};

class TestWriter : public SinkWriter {
 public:
  explicit TestWriter(Written* written) : written_(*written) {}

  bool IsWanted() const override { return written_.is_wanted; }
  void Write(const Observation& observation, std::size_t /*waiting*/) override {
    std::unique_lock lock(written_.mutex);
    written_.changed.wait(lock, [this] { return !written_.is_held; });
    written_.frames.push_back(std::stoi(observation.frame.name));
  }
  void Write(const FlightReport&) override { ++written_.reports; }
  void Write(const TeamReport&) override { ++written_.team_reports; }
  void Write(const SessionEvent& event) override { written_.events.push_back(event.text); }
  void Finish(std::size_t dropped) override {
    written_.dropped = dropped;
    ++written_.finished;
  }

 private:
  Written& written_;
};

Observation ObservationOf(int number) {
  return {{std::to_string(number), Time(Duration(number)), {}}, LandingObservation()};
}

TEST(AsynchronousSinkTest, WritesAllInOrder) {
  Written written;
  AsynchronousSink sink({.thread_name = "test", .frames = 8},
                        std::make_unique<TestWriter>(&written));
  for (int i = 0; i < 8; ++i) sink.Take(ObservationOf(i));
  sink.Take(SessionEvent{Now(), EventLevel::kInfo, "one"});
  sink.Take(SessionEvent{Now(), EventLevel::kInfo, "two"});
  sink.Take(FlightReport());
  sink.Take(TeamReport());
  sink.Finish();
  EXPECT_THAT(written.frames, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  EXPECT_THAT(written.events, ElementsAre("one", "two"));
  EXPECT_EQ(written.reports, 1);
  EXPECT_EQ(written.team_reports, 1);
  EXPECT_EQ(written.dropped, 0u);
  sink.Take(ObservationOf(9));
  sink.Finish();
  EXPECT_EQ(written.frames.size(), 8u) << "it has ended";
  EXPECT_EQ(written.finished, 1);
}

// When a disk or a network stalls, only the oldest frames are lost, and no caller waits.
TEST(AsynchronousSinkTest, StalledWriterDoesNotBlockCaller) {
  Written written;
  written.is_held = true;
  AsynchronousSink sink({.thread_name = "test", .frames = 4},
                        std::make_unique<TestWriter>(&written));
  for (int i = 0; i < 100; ++i) sink.Take(ObservationOf(i));
  {
    const std::lock_guard lock(written.mutex);
    written.is_held = false;
  }
  written.changed.notify_all();
  sink.Finish();
  ASSERT_GE(written.frames.size(), 4u);
  EXPECT_EQ(written.frames.size() + written.dropped, 100u);
  EXPECT_EQ(written.frames.back(), 99);
}

TEST(AsynchronousSinkTest, KeepsNoUnwantedFrame) {
  Written written;
  written.is_wanted = false;
  AsynchronousSink sink({.thread_name = "test"}, std::make_unique<TestWriter>(&written));
  EXPECT_FALSE(sink.IsWanted());
  sink.Take(ObservationOf(0));
  sink.Take(SessionEvent{Now(), EventLevel::kInfo, "an event"});
  sink.Finish();
  EXPECT_TRUE(written.frames.empty());
  EXPECT_EQ(written.events.size(), 1u);
}

// Writes down the order in which sinks end.
class NotedSink : public ObservationSink {
 public:
  NotedSink(int number, std::vector<int>* ended) : number_(number), ended_(*ended) {}
  ~NotedSink() override { ended_.push_back(-number_); }
  NotedSink(const NotedSink&) = delete;
  NotedSink& operator=(const NotedSink&) = delete;
  void Take(const Observation&) override {}
  void Finish() override { ended_.push_back(number_); }

 private:
  int number_;
  std::vector<int>& ended_;
};

TEST(ObservationSinksTest, EndInReverseOrder) {
  std::vector<int> ended;
  {
    ObservationSinks sinks;
    EXPECT_FALSE(sinks.IsWanted());
    sinks.Add(std::make_unique<NotedSink>(1, &ended));
    sinks.Add(std::make_unique<NotedSink>(2, &ended));
    EXPECT_TRUE(sinks.IsWanted());
    sinks.Finish();
  }
  EXPECT_THAT(ended, ElementsAre(2, 1, -2, -1));
}

}  // namespace
}  // namespace kestrel
