// SPDX-License-Identifier: BSD-3-Clause
// Whole sessions: a source, the vision, a recorder and all sinks that there are.
#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/console/flight/flight_console.h"
#include "kestrel/app/foxglove/flight_live.h"
#include "kestrel/app/foxglove/mcap_sink.h"
#include "kestrel/app/foxglove/test_protobuf.h"
#include "kestrel/app/web_server/test_browser.h"
#include "kestrel/comms/dds/ros2_node.h"
#include "kestrel/comms/dds/team_topic.h"
#include "kestrel/comms/dds/test_dds.h"
#include "kestrel/comms/team/team_fusion.h"
#include "kestrel/comms/team/team_member.h"
#include "kestrel/comms/team/team_view.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/flight/onboard/recording_switch.h"
#include "kestrel/flight/ros/ros2_result_connection.h"
#include "kestrel/flight/ros/ros_sink.h"
#include "kestrel/flight/session/hunt_task.h"
#include "kestrel/flight/session/land_task.h"
#include "kestrel/flight/session/observation_sinks.h"
#include "kestrel/flight/session/task.h"
#include "kestrel/flight/session/team_sharing.h"
#include "kestrel/io/recording/open_source.h"
#include "test_session.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;
using ::testing::IsEmpty;

TaskView LandingViewOfSession() { return ViewOf(SmallCamera(), LandingPipelineOptions()); }

// All sinks of a flight, as `kestrel fly --console --mcap --dds` has them.
class AllSinks {
 public:
  AllSinks(ObservationSinks* to, const std::string& mcap, int domain) : sinks(*to) {
    witness = sinks.Add(std::make_unique<Witness>());
    const CameraIntrinsics camera = SmallCamera().intrinsics;
    live = sinks.Add(std::make_unique<FlightLive>(camera, LandingViewOfSession(), 30));
    console = sinks.Add(std::make_unique<FlightConsole>(
        AnyPort(), "a flight", std::vector<TaskView>{LandingViewOfSession()},
        FlightExamination(SmallCamera(), ".", 0), live->channels()));
    sinks.Add(OpenMcapSink(mcap, /*replace=*/false, LandTask({}), SmallCamera(), {},
                           [this](const std::string& text) { Report(text); }));
    if (Ros2Node::Knows("tf2_msgs/TFMessage")) AddRos(domain);
  }

  int port() const {
    const std::string url = console->urls().front();
    return std::stoi(url.substr(url.rfind(':') + 1));
  }

  ObservationSinks& sinks;
  Witness* witness;
  FlightLive* live;
  FlightConsole* console;

 private:
  void Report(const std::string& text) {
    sinks.Take(SessionEvent{Now(), EventLevel::kWarning, text});
  }

  void AddRos(int domain) {
    const DdsOptions options;
    auto connection = std::make_unique<Ros2ResultConnection>(
        std::make_shared<Ros2Node>(domain, Ros2NodeOptions()), options.node, kLandingTopics);
    const RosFrames frames{"camera", "map", "base_link", RosTimeAhead()};
    sinks.Add(MakeRosSink(
        std::make_unique<RosResults>(std::move(connection), options, frames, SmallCamera(),
                                     LandingPipelineOptions(), DefaultObjectModel()),
        [this](const std::string& text) { Report(text); }));
  }
};

// A node of ROS that counts the detections that it hears, in a thread of its own.
class Listener {
 public:
  explicit Listener(int domain) {
    if (!Ros2Node::Knows(Detection3DArrayMessage::kType)) return;
    node_.emplace(domain, Ros2NodeOptions{"listener"});
    node_->Subscribe("/kestrel/detections", Detection3DArrayMessage::kType, kDefaultQos);
    thread_ = std::thread([this] {
      while (!is_over_) {
        node_->Take(milliseconds(20), [this](std::size_t, std::string_view) { ++heard_; });
      }
    });
  }
  ~Listener() {
    is_over_ = true;
    if (thread_.joinable()) thread_.join();
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  bool HasHeard() const { return !node_ || heard_ > 0; }

 private:
  std::optional<Ros2Node> node_;
  std::atomic<bool> is_over_{false};
  std::atomic<int> heard_{0};
  std::thread thread_;
};

// A browser that looks at the page as long as it is there.
class Watcher {
 public:
  explicit Watcher(int port) : socket_(port), thread_([this] { Watch(); }) {}
  ~Watcher() {
    socket_.Shutdown();
    thread_.join();
  }
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  int messages() const { return messages_; }

 private:
  void Watch() {
    while (socket_.Read()) ++messages_;
  }

  TestSocket socket_;
  std::atomic<int> messages_{0};
  std::thread thread_;
};

// Returns the number of frames that the MCAP file lacks by its own words: on a busy computer it
// may.
std::size_t LeftOutByMcap(const std::string& events) {
  const std::string_view reported = "--mcap: ";
  const std::size_t at = events.find(reported);
  return at == std::string::npos ? 0 : std::stoul(events.substr(at + reported.size()));
}

TEST(WholeSession, StartsAndStopsSeveralTimes) {
  constexpr int kFrames = 3000;  // half a minute; it is stopped before
  const TestFolder folder;
  const int domain = TestDomain();
  Listener listener(domain);
  for (const std::string round : {"0", "1", "2"}) {
    const OpenedLiveSource camera = DrawnSource(kFrames, PatternImage, 3);
    SessionOptions options = SmallDisk();
    options.record = folder / ("first" + round);
    options.output = folder / ("tables" + round);
    const auto session = MakeSession(camera, LandTask({}), options);
    const AllSinks all(&session->sinks(), folder / (round + ".mcap"), domain);
    const Watcher watcher(all.port());
    bool is_restarted = false;
    const FlightEnd end = session->Run([&] {
      if (session->recording().Get()->counters().images < 10) return false;
      if (is_restarted) return true;
      EXPECT_TRUE(session->recording().Stop());
      EXPECT_TRUE(session->recording().Start(folder / ("second" + round), /*replace=*/false));
      is_restarted = true;
      return false;
    });
    EXPECT_EQ(end.outcome, FlightOutcome::kStopped);
    const Witness::Seen seen = all.witness->seen();
    EXPECT_GT(seen.frames.size(), 10u);
    EXPECT_GT(seen.found, 5) << "of " << seen.frames.size();
    EXPECT_GT(seen.reports, 2);
    const std::size_t written = ReadMessages(folder / (round + ".mcap")).at("/result").size();
    EXPECT_GT(written, 5u);
    EXPECT_EQ(written + LeftOutByMcap(seen.events), seen.frames.size()) << seen.events;
    EXPECT_GT(watcher.messages(), 5);
    for (const std::string part : {"first", "second"}) {
      EXPECT_GT(*OpenSource({folder / (part + round)})->frame_count(), 0u) << part;
    }
  }
  EXPECT_TRUE(listener.HasHeard());
}

TEST(WholeSession, StopsAtOnce) {
  const TestFolder folder;
  const int domain = TestDomain();
  for (int round = 0; round < 5; ++round) {
    const OpenedLiveSource camera = DrawnSource(1000, PatternImage, 3);
    SessionOptions options = SmallDisk();
    options.record = folder / std::to_string(round);
    const auto session = MakeSession(camera, LandTask({}), options);
    const AllSinks all(&session->sinks(), folder / (std::to_string(round) + ".mcap"), domain);
    EXPECT_EQ(session->Run([] { return true; }).outcome, FlightOutcome::kStopped);
  }
}

TEST(WholeSession, AppliesChangedOptionsFromNextFrame) {
  const OpenedLiveSource camera = DrawnSource(100, PatternImage, 3);
  const auto session = MakeSession(camera, LandTask({}));
  const Witness* const witness = session->sinks().Add(std::make_unique<Witness>());
  std::optional<Witness::Seen> changed;
  session->Run([&] {
    if (changed || witness->seen().found == 0) return false;
    TaskOptions options;
    options.landing.detector.min_quality = 1;
    session->Change(options, /*altitude_m=*/std::nullopt);
    session->BetweenFrames([&] { changed = witness->seen(); });
    return false;
  });
  ASSERT_TRUE(changed);
  EXPECT_GT(witness->seen().frames.size(), changed->frames.size());
  EXPECT_EQ(witness->seen().found, changed->found);
}

// A UAV that hunts and shares its map with its team.
class TeamUav {
 public:
  TeamUav(const std::string& name, int domain)
      : member_({name, 1}, {}), topic_(domain, "sessions", name) {}

  void Fly() {
    session_->Run([this] {
      Exchange();
      return witness_->seen().team.size() > 0 && member_.Known().size() == 2;
    });
  }

  std::size_t known() const { return member_.Known().size(); }
  Witness::Seen seen() const { return witness_->seen(); }

 private:
  void Exchange() {
    if (auto map = maps_->TakeNewest()) member_.Share(std::move(map->objects), Now());
    topic_.Receive([this](auto bytes) { member_.Hear(bytes, Now()); });
    member_.Tick(Now(), [this](auto bytes) { topic_.Send(bytes); });
    session_->sinks().Take(TeamReport{Now(), OwnMap(ViewTeam(member_, Now(), &fusion_))});
  }

  TeamMember member_;
  TeamTopic topic_;
  TeamFusion fusion_{TeamOptions(), ObjectMapOptions()};
  const OpenedLiveSource camera_ = DrawnSource(300, DiscImage, 2);
  const std::unique_ptr<LiveSession> session_ =
      MakeSession(camera_, HuntTask({}, DefaultObjectModel()));
  Witness* const witness_ = session_->sinks().Add(std::make_unique<Witness>());
  MapCopies* const maps_ = session_->sinks().Add(
      std::make_unique<MapCopies>(session_->vision().map(), milliseconds(50)));
};

TEST(WholeSession, TeamSharesMap) {
  const int domain = TestDomain();
  if (!Ros2Node::Knows("tf2_msgs/TFMessage")) GTEST_SKIP() << "this build has no DDS";
  TeamUav a("a", domain);
  TeamUav b("b", domain);
  std::thread other([&] { b.Fly(); });
  a.Fly();
  other.join();
  for (const TeamUav* uav : {&a, &b}) {
    EXPECT_EQ(uav->known(), 2u);
    EXPECT_FALSE(uav->seen().team.empty());
    EXPECT_EQ(uav->seen().events, "ended by the user\n");
  }
}

}  // namespace
}  // namespace kestrel
