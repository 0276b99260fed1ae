// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/guard/guard_exchange.h"

#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/packet_parser.h"
#include "kestrel/comms/mavlink/packet_writer.h"

namespace kestrel {
namespace {

class GuardExchangeTest : public ::testing::Test {
 protected:
  GuardExchangeTest() {
    life_.task = GuardTask::kLower;
    life_.kind = AutopilotKind::kArduPilot;
    guard_.TakeLife(life_.task, life_.kind, now_);
  }

  template <class Message>
  void Hear(const Message& message) {
    parser_.Parse(writer_.Write(message), [this](const mavlink::Packet& packet) {
      TakePacket(packet, life_, now_, &guard_);
    });
  }
  void HearTransmitter(std::uint32_t present, std::uint32_t healthy) {
    mavlink::SysStatus status;
    status.onboard_control_sensors_present = present;
    status.onboard_control_sensors_health = healthy;
    Hear(status);
    Hear(mavlink::RcChannels{.chancount = 8, .chan3_raw = 1520});
  }
  // Returns the guard's action once the program is gone.
  GuardAction Abandon() {
    guard_.TakeEnd();
    return guard_.Update(now_);
  }

  Time now_ = TimeFromNanoseconds(1'000'000'000);
  FlightGuard guard_{std::chrono::milliseconds(200)};
  GuardLife life_;
  mavlink::PacketParser parser_;
  mavlink::PacketWriter writer_{1, 1};
};

TEST_F(GuardExchangeTest, GivesUavToPilotOfReceivedTransmitter) {
  HearTransmitter(mavlink::kSensorReceiver, mavlink::kSensorReceiver);
  EXPECT_EQ(Abandon().mode, FlightMode::kAltitude);
}

// As PX4 reports one that is lost, and as ArduPilot does.
TEST_F(GuardExchangeTest, LandsWhenTransmitterIsLost) {
  const GuardLife life = life_;
  for (const bool is_px4 : {true, false}) {
    guard_ = FlightGuard(std::chrono::milliseconds(200));
    guard_.TakeLife(life.task, life.kind, now_);
    HearTransmitter(is_px4 ? 0 : mavlink::kSensorReceiver, is_px4 ? mavlink::kSensorReceiver : 0);
    EXPECT_EQ(Abandon().mode, FlightMode::kLand);
  }
}

TEST_F(GuardExchangeTest, LevelsWithPresentHeading) {
  constexpr float kHeading = 2.5F;
  Hear(mavlink::AttitudeQuaternion{.q1 = std::cos(kHeading / 2), .q4 = std::sin(kHeading / 2)});
  mavlink::SetAttitudeTarget level;
  SendAction(Abandon(), life_, [&](const auto& message) {
    if constexpr (requires { message.thrust; }) level = message;
  });
  EXPECT_EQ(level.thrust, 0.5F);
  EXPECT_NEAR(level.q[0], std::cos(kHeading / 2), 1e-6);
  EXPECT_NEAR(level.q[3], std::sin(kHeading / 2), 1e-6);
}

TEST_F(GuardExchangeTest, TakesRefusalOfAnyModeCommand) {
  HearTransmitter(mavlink::kSensorReceiver, mavlink::kSensorReceiver);
  EXPECT_EQ(Abandon().mode, FlightMode::kAltitude);
  Hear(mavlink::CommandAck{mavlink::kCommandDoSetMode, mavlink::kResultTemporarilyRejected});
  now_ += std::chrono::milliseconds(400);
  EXPECT_EQ(guard_.Update(now_).mode, FlightMode::kLand);
}

}  // namespace
}  // namespace kestrel
