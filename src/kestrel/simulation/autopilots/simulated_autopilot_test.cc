// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/simulated_autopilot.h"

#include <chrono>
#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/socket_address.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/simulation/autopilots/test_autopilot.h"

namespace kestrel {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

class SimulatedAutopilotTest : public testing::Test {
 protected:
  SimulatedAutopilotTest()
      : world_(TestVehicle("standing", 0), Now(), 1),
        address_("127.0.0.1:" + std::to_string(FreeLoopbackPort())),
        companion_("udpin://" + address_, ConnectionOptions()) {}

  // Listens until 'done' returns true or the time is over.
  bool Listen(Duration longest, const std::function<bool(const mavlink::Packet&)>& done) {
    const Time end = Now() + longest;
    bool is_done = false;
    while (!is_done && Now() < end) {
      companion_.Receive(10ms, [&](const mavlink::Packet& packet, Time /*received*/) {
        is_done = is_done || done(packet);
      });
    }
    return is_done;
  }
  bool HearsHeartbeat(Duration longest) {
    return Listen(longest, [](const mavlink::Packet& packet) {
      const auto heartbeat = packet.As<mavlink::Heartbeat>();
      return heartbeat && heartbeat->autopilot == mavlink::kAutopilotPx4;
    });
  }

  VehicleWorld world_;
  // A port of its own: tests that run at the same time must not hear each other.
  std::string address_;
  Connection companion_;
};

TEST_F(SimulatedAutopilotTest, SpeaksMavlinkOverUdp) {
  SimulatedAutopilotOptions options;
  options.firmware = "px4";
  options.model.uptime_s = 500;
  SimulatedAutopilot autopilot(options, "udpout://" + address_, &world_, 1);
  autopilot.Start();
  ASSERT_TRUE(HearsHeartbeat(3s));
  companion_.Send(mavlink::Timesync{.tc1 = 0, .ts1 = 42});
  EXPECT_TRUE(Listen(3s, [](const mavlink::Packet& packet) {
    const auto answer = packet.As<mavlink::Timesync>();
    return answer && answer->ts1 == 42 && answer->tc1 > 500'000'000'000;
  }));
  autopilot.SendGarbage(5000);
  EXPECT_TRUE(HearsHeartbeat(3s)) << "garbage in between does no harm";
}

TEST_F(SimulatedAutopilotTest, IsSilentWhileLinkIsDown) {
  SimulatedAutopilotOptions options;
  options.firmware = "px4";
  SimulatedAutopilot autopilot(options, "udpout://" + address_, &world_, 1);
  autopilot.Start();
  ASSERT_TRUE(HearsHeartbeat(3s));
  autopilot.set_link_down(true);
  Listen(200ms, [](const mavlink::Packet&) { return false; });
  EXPECT_FALSE(Listen(300ms, [](const mavlink::Packet&) { return true; }));
  autopilot.set_link_down(false);
  EXPECT_TRUE(HearsHeartbeat(3s));
}

TEST_F(SimulatedAutopilotTest, InterruptsLinkByOptions) {
  SimulatedAutopilotOptions options;
  options.firmware = "px4";
  options.link.down_after_s = 0;
  options.link.down_for_s = 0.5;
  SimulatedAutopilot autopilot(options, "udpout://" + address_, &world_, 1);
  autopilot.Start();
  EXPECT_FALSE(Listen(300ms, [](const mavlink::Packet&) { return true; }));
  EXPECT_TRUE(HearsHeartbeat(3s));
}

TEST(LinkFaultsTest, DelaysMessagesInOrderOrDropsThem) {
  LinkFaultOptions options;
  options.delay_s = 0.1;
  options.jitter_s = 0.03;
  options.loss = 0.2;
  DelayLine<int> line(options, Random(1));
  Time now = kTestStart;
  int received = 0;
  int last = -1;
  constexpr int kMessages = 2000;
  for (int i = 0; i < kMessages; ++i, now += 5ms) {
    line.Push(now, i);
    while (const auto message = line.Pop(now)) {
      EXPECT_GT(*message, last);
      last = *message;
      ++received;
      EXPECT_GE(5 * (i - last), 70);
      EXPECT_LE(5 * (i - last), 135);
    }
  }
  EXPECT_NEAR(received, 0.8 * kMessages, 80);
}

TEST(SimulatedAutopilotOptionsTest, ReportsInvalidOptions) {
  SimulatedAutopilotOptions options;
  options.firmware = "inav";
  options.link.loss = 2;
  options.model.pilot.heading_deg = 1000;
  EXPECT_THAT(ViolationsOf(options),
              testing::UnorderedElementsAre("firmware is 'inav', expected ardupilot or px4",
                                            "link.loss is 2, expected 0 to 1",
                                            "pilot.heading_deg is 1000, expected -360 to 360"));
}

}  // namespace
}  // namespace kestrel
