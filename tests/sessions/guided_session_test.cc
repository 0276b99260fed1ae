// SPDX-License-Identifier: BSD-3-Clause
// Sessions that guide: what they say of a pad that the camera does not see from the search
// altitude, and how often they request the autopilot's mode.
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/socket_address.h"
#include "kestrel/flight/session/land_task.h"
#include "test_session.h"

namespace kestrel {
namespace {

using testing::HasSubstr;
using testing::Not;

// Returns what a session says that guides to a tag of 'size_m'. Nobody is at the link's other end.
std::string EventsWithTagOf(double size_m) {
  LandingPipelineOptions landing;
  landing.target.kind = "apriltag";
  landing.target.apriltag.size_m = size_m;
  SessionOptions options{.autopilot = "udpout://127.0.0.1:9", .guides = true};
  options.flight.guard.enabled = false;
  const OpenedLiveSource camera = DrawnSource(3, PatternImage, 3);
  const auto session = MakeSession(camera, LandTask(landing), options);
  const Witness* const witness = session->sinks().Add(std::make_unique<Witness>());
  session->Run();
  return witness->seen().events;
}

TEST(GuidedSession, LimitsSearchToSightRange) {
  // The camera's focal length is 150 px; a tag with its margin takes 20 px, 10 cells of 8 in its
  // size.
  const std::string small = EventsWithTagOf(0.8);
  EXPECT_THAT(small, HasSubstr("sees the pad from 7.5 m at most"));
  EXPECT_THAT(small, HasSubstr("searches at 6.0 m, not at search_altitude_m 10, and out to 4.0 m"));
  EXPECT_THAT(small, Not(HasSubstr("limits.floor_m")));
  EXPECT_THAT(EventsWithTagOf(2), Not(HasSubstr("sees the pad")));
  EXPECT_THAT(EventsWithTagOf(0.2), HasSubstr("limits.floor_m 3 is above that"));
}

// An autopilot that does nothing but live and note the intervals of messages that are requested of
// it.
class RequestedAutopilot {
 public:
  RequestedAutopilot()
      : url_(fmt::format("127.0.0.1:{}", FreeLoopbackPort())),
        connection_("udpin://" + url_, {.system_id = 1, .component_id = 1, .signing_key = ""}),
        thread_([this](const std::stop_token& stop) { Run(stop); }) {}

  std::string url() const { return "udpout://" + url_; }

  // Message -> microseconds. Ends the autopilot.
  const std::map<std::uint32_t, float>& Intervals() {
    thread_.request_stop();
    thread_.join();
    return intervals_us_;
  }

 private:
  void Run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      connection_.Send(mavlink::Heartbeat{mavlink::kTypeQuadrotor, mavlink::kAutopilotArduPilot,
                                          mavlink::kModeFlagArmed, 4, 4, 3});
      connection_.Receive(std::chrono::milliseconds(20), [this](const auto& packet, Time) {
        const auto command = packet.template As<mavlink::CommandLong>();
        if (!command || command->command != mavlink::kCommandSetMessageInterval) return;
        intervals_us_[static_cast<std::uint32_t>(command->param1)] = command->param2;
      });
    }
  }

  std::string url_;
  Connection connection_;
  std::map<std::uint32_t, float> intervals_us_;
  std::jthread thread_;
};

// Returns the interval of heartbeats that a session requests; 0: it requests none.
float HeartbeatInterval(bool guides) {
  RequestedAutopilot autopilot;
  SessionOptions options{.autopilot = autopilot.url(), .guides = guides};
  options.flight.guard.enabled = false;
  const OpenedLiveSource camera = DrawnSource(60, PatternImage, 3);
  MakeSession(camera, LandTask({}), options)->Run();
  const auto& intervals = autopilot.Intervals();
  const auto found = intervals.find(mavlink::Heartbeat::kId);
  return found == intervals.end() ? 0 : found->second;
}

// A pilot who takes the UAV back waits no longer than that.
TEST(GuidedSession, RequestsHeartbeatsAtTwentyHertz) {
  EXPECT_EQ(HeartbeatInterval(/*guides=*/true), 50000);
  EXPECT_EQ(HeartbeatInterval(/*guides=*/false), 0);
}

}  // namespace
}  // namespace kestrel
