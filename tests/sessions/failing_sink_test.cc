// SPDX-License-Identifier: BSD-3-Clause
// Sessions in which one receiver of the results dies or stalls: all others get every result, the
// session ends in time, and says what was lost.
#include <csignal>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <sys/resource.h>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/console/flight/flight_console.h"
#include "kestrel/app/foxglove/mcap_sink.h"
#include "kestrel/app/web_server/test_browser.h"
#include "kestrel/comms/dds/ros2_node.h"
#include "kestrel/comms/dds/test_dds.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/flight/ros/ros2_result_connection.h"
#include "kestrel/flight/ros/ros_sink.h"
#include "kestrel/flight/session/asynchronous_sink.h"
#include "kestrel/flight/session/land_task.h"
#include "kestrel/flight/session/observation_sinks.h"
#include "test_session.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

constexpr int kSessionFrames = 60;
constexpr std::size_t kFailsAt = 10;  // frames

// Throws in one of its functions.
class ThrowingSink : public ObservationSink {
 public:
  enum Where { kFrame, kReport, kEvent, kEnd };

  explicit ThrowingSink(Where where) : where_(where) {}
  void Take(const Observation&) override { Throw(kFrame); }
  void Take(const FlightReport&) override { Throw(kReport); }
  void Take(const SessionEvent&) override { Throw(kEvent); }
  void Finish() override { Throw(kEnd); }

 private:
  void Throw(Where where) const {
    if (where == where_) throw std::runtime_error("the sink is broken");
  }

  Where where_;
};

// Does something with every frame, in the thread of an AsynchronousSink.
class BusyWriter : public SinkWriter {
 public:
  BusyWriter(std::function<void()> work, std::size_t* dropped)
      : work_(std::move(work)), dropped_(*dropped) {}
  void Write(const Observation&, std::size_t /*waiting*/) override { work_(); }
  void Finish(std::size_t dropped) override { dropped_ = dropped; }

 private:
  std::function<void()> work_;
  std::size_t& dropped_;
};

class FailingSink : public ::testing::Test {
 protected:
  FailingSink() { Open(SmallDisk()); }

  void Open(const SessionOptions& options) {
    session_ = MakeSession(camera_, LandTask({}), options);
    before_ = sinks().Add(std::make_unique<Witness>());
  }
  ObservationSinks& sinks() { return session_->sinks(); }

  void Report(const std::string& text) {
    sinks().Take(SessionEvent{Now(), EventLevel::kWarning, text});
  }

  // Flies with a witness before and one behind all sinks. 'at_frame' is called once, in flight.
  void Fly(const std::function<void()>& at_frame = {}) {
    after_ = sinks().Add(std::make_unique<Witness>());
    bool is_called = !at_frame;
    session_->Run([&] {
      if (is_called || before_->seen().frames.size() < kFailsAt) return false;
      is_called = true;
      sinks().Take(SessionEvent{Now(), EventLevel::kInfo, "an event"});
      at_frame();
      return false;
    });
    finish_time_ = Now() - after_->seen().end;
    processed_ = std::stoul(session_->State());
  }

  // Every frame that the vision has processed has reached the sinks before and behind.
  void ExpectAllResults() const {
    EXPECT_GT(processed_, kFailsAt);
    EXPECT_EQ(before_->seen().frames.size(), processed_);
    EXPECT_EQ(after_->seen().frames, before_->seen().frames);
    EXPECT_GT(after_->seen().reports, 2);
  }

  std::string Reported() const { return before_->seen().events; }

  const TestFolder folder_;
  const OpenedLiveSource camera_ = DrawnSource(kSessionFrames, PatternImage, 3);
  std::unique_ptr<LiveSession> session_;
  Witness* before_ = nullptr;
  Witness* after_ = nullptr;
  std::size_t processed_ = 0;
  Duration finish_time_{};
};

class Throwing : public FailingSink, public ::testing::WithParamInterface<ThrowingSink::Where> {};

TEST_P(Throwing, LosesOnlyItself) {
  sinks().Add(std::make_unique<ThrowingSink>(GetParam()));
  Fly([] {});
  ExpectAllResults();
  EXPECT_THAT(Reported(), HasSubstr("the sink is broken: the flight goes on without it"));
}

INSTANTIATE_TEST_SUITE_P(Sinks, Throwing,
                         ::testing::Values(ThrowingSink::kFrame, ThrowingSink::kReport,
                                           ThrowingSink::kEvent, ThrowingSink::kEnd));

TEST_F(FailingSink, SummaryReportsFailure) {
  sinks().Add(std::make_unique<ThrowingSink>(ThrowingSink::kFrame));
  Fly();
  EXPECT_THAT(session_->Summary(), HasSubstr("has failed: the sink is broken"));
}

TEST_F(FailingSink, SessionRethrowsErrorOfCaller) {
  EXPECT_THROW(session_->Run([]() -> bool { throw std::runtime_error("no more"); }),
               std::runtime_error);
}

TEST_F(FailingSink, SurvivesThrowingWriter) {
  std::size_t dropped = 0;
  AsynchronousSinkOptions options{.thread_name = "broken", .notify = {}};
  options.notify = [this](const std::string& error) { Report("broken: " + error); };
  sinks().Add(std::make_unique<AsynchronousSink>(
      options,
      std::make_unique<BusyWriter>([] { throw std::runtime_error("no disk"); }, &dropped)));
  Fly();
  ExpectAllResults();
  EXPECT_THAT(Reported(), HasSubstr("broken: no disk"));
}

// Without a limit the end would wait for all that waits: 8 frames, 8 s.
TEST_F(FailingSink, SurvivesStalledWriter) {
  std::size_t dropped = 0;
  std::size_t written = 0;
  sinks().Add(std::make_unique<AsynchronousSink>(
      AsynchronousSinkOptions{
          .thread_name = "stalled", .last_patience = milliseconds(500), .notify = {}},
      std::make_unique<BusyWriter>(
          [&] {
            std::this_thread::sleep_for(seconds(1));  // the stalled disk
            ++written;
          },
          &dropped)));
  Fly();
  ExpectAllResults();
  EXPECT_LT(finish_time_, seconds(4));
  EXPECT_GE(written, 1u);
  EXPECT_EQ(written + dropped, processed_) << "each frame is written or counted";
}

TEST_F(FailingSink, SurvivesFullDiskOfMcapFile) {
  sinks().Add(OpenMcapSink("/dev/full", /*replace=*/true, LandTask({}), SmallCamera(), {},
                           [this](const std::string& text) { Report(text); }));
  Fly();
  ExpectAllResults();
  EXPECT_THAT(Reported(), HasSubstr("/dev/full"));
}

TEST_F(FailingSink, SurvivesFailingDiskOfRecording) {
  SessionOptions options = SmallDisk();
  options.record = folder_ / "flight";
  Open(options);
  // At once, as the recorder goes on writing into it.
  Fly([&] { std::filesystem::rename(folder_ / "flight/mav0", folder_ / "gone"); });
  ExpectAllResults();
  EXPECT_THAT(Reported(), HasSubstr("no more images, the flight goes on"));
}

// A limit on the size of files simulates the full disk.
TEST_F(FailingSink, SurvivesFullDiskOfTables) {
  Open({.output = folder_ / "tables"});
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  Fly([&] {
    const rlimit small{2000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ExpectAllResults();
  EXPECT_THAT(Reported(), HasSubstr("the results cannot be written any more"));
}

TEST_F(FailingSink, SurvivesVanishedBrowser) {
  FlightConsole* const console = sinks().Add(std::make_unique<FlightConsole>(
      AnyPort(), "a flight", std::vector<TaskView>{ViewOf(SmallCamera(), LandingPipelineOptions())},
      FlightExamination(SmallCamera(), ".", 0)));
  const std::string url = console->urls().front();
  const int port = std::stoi(url.substr(url.rfind(':') + 1));
  auto leaving = std::make_unique<TestSocket>(port);
  TestSocket staying(port);
  ASSERT_TRUE(leaving->Next("hello") && staying.Next("hello"));
  leaving->Send(R"({"images": true})");
  Fly([&] { leaving.reset(); });
  ExpectAllResults();
  EXPECT_TRUE(staying.Next("sample"));
}

TEST_F(FailingSink, SurvivesVanishedRosPeer) {
  const int domain = TestDomain();
  if (!Ros2Node::Knows(Detection3DArrayMessage::kType)) GTEST_SKIP() << "this build has no DDS";
  auto peer = std::make_unique<Ros2Node>(domain, Ros2NodeOptions{"peer"});
  peer->Subscribe("/kestrel/detections", Detection3DArrayMessage::kType, kDefaultQos);
  const DdsOptions options;
  auto connection = std::make_unique<Ros2ResultConnection>(
      std::make_shared<Ros2Node>(domain, Ros2NodeOptions()), options.node, kLandingTopics);
  sinks().Add(MakeRosSink(
      std::make_unique<RosResults>(std::move(connection), options,
                                   RosFrames{"camera", "map", "base_link", RosTimeAhead()},
                                   SmallCamera(), LandingPipelineOptions(), DefaultObjectModel()),
      [this](const std::string& text) { Report(text); }));
  Fly([&] { peer.reset(); });
  ExpectAllResults();
  EXPECT_LT(finish_time_, seconds(5));
}

}  // namespace
}  // namespace kestrel
