// SPDX-License-Identifier: BSD-3-Clause
// A ground station behind the autopilot's link marks what a session follows, and learns where it
// is.
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/camera_messages.h"
#include "kestrel/comms/mavlink/link_url.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/packet_parser.h"
#include "kestrel/comms/mavlink/packet_writer.h"
#include "kestrel/comms/mavlink/socket_address.h"
#include "kestrel/comms/mavlink/transport.h"
#include "kestrel/flight/session/follow_task.h"
#include "test_session.h"

namespace kestrel {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// An autopilot that forwards what a ground station sends, and the ground station.
class Ground {
 public:
  explicit Ground(const std::string& address)
      : transport_(OpenTransport(ParseLinkUrl("udpout://" + address))) {}

  template <class Message>
  void SendBy(mavlink::PacketWriter* writer, const Message& message) {
    transport_->Send(writer->Write(message));
  }
  void SendHeartbeat() {
    SendBy(&autopilot_, mavlink::Heartbeat{mavlink::kTypeQuadrotor, mavlink::kAutopilotArduPilot,
                                           mavlink::kModeFlagArmed, 4, 4, 3});
  }
  void SendCommand(std::uint16_t command, const std::vector<float>& parameters) {
    mavlink::CommandLong message;
    message.target_system = 1;
    message.target_component = 100;
    message.command = command;
    float* const fields[] = {&message.param1, &message.param2, &message.param3, &message.param4};
    for (std::size_t i = 0; i < parameters.size(); ++i) *fields[i] = parameters[i];
    SendBy(&station_, message);
  }
  void Receive() {
    std::vector<std::uint8_t> bytes(2048);
    while (const std::size_t size = transport_->Receive(Duration::zero(), bytes)) {
      parser_.Parse(std::span(bytes).first(size), [this](const mavlink::Packet& packet) {
        if (packet.component != 100) return;
        if (packet.As<mavlink::Heartbeat>()) ++heartbeats;
        if (const auto ack = packet.As<mavlink::CommandAck>()) acks.push_back(*ack);
        if (const auto one = packet.As<mavlink::CameraTrackingImageStatus>()) status = *one;
      });
    }
  }

  int heartbeats = 0;
  std::vector<mavlink::CommandAck> acks;
  std::optional<mavlink::CameraTrackingImageStatus> status;

 private:
  std::unique_ptr<Transport> transport_;
  mavlink::PacketParser parser_;
  mavlink::PacketWriter autopilot_{1, 1}, station_{255, 190};
};

// The disc is at (80 to 84, 60) px, with a radius of 8.
TEST(GroundStationSession, MarksAndIsInformed) {
  const std::string address = fmt::format("127.0.0.1:{}", FreeLoopbackPort());
  const OpenedLiveSource camera = DrawnSource(3000, DiscImage, 2);
  const auto session =
      MakeSession(camera, FollowTask({}), SessionOptions{.autopilot = "udpin://" + address});
  const Witness* const witness = session->sinks().Add(std::make_unique<Witness>());
  Ground ground(address);
  int calls = 0;
  const auto is_followed = [&] {
    return ground.status && ground.status->tracking_status == mavlink::kTrackingActive;
  };
  session->Run([&] {
    ground.SendHeartbeat();
    ground.Receive();
    ++calls;
    if (calls == 10) {
      ground.SendCommand(mavlink::kCommandSetMessageInterval,
                         {mavlink::CameraTrackingImageStatus::kId, 50'000});
      ground.SendCommand(mavlink::kCommandTrackRectangle,
                         {68.0f / 160, 48.0f / 120, 96.0f / 160, 72.0f / 120});
    }
    return is_followed() || calls > 200;
  });
  ASSERT_TRUE(is_followed()) << witness->seen().events;
  EXPECT_NEAR(0.5 * (ground.status->rec_top_x + ground.status->rec_bottom_x) * 160, 82, 5);
  EXPECT_NEAR(0.5 * (ground.status->rec_top_y + ground.status->rec_bottom_y) * 120, 60, 5);
  ASSERT_EQ(ground.acks.size(), 2u);
  for (const auto& ack : ground.acks) EXPECT_EQ(ack.result, mavlink::kResultAccepted);
  EXPECT_GE(ground.heartbeats, 1);
  EXPECT_THAT(witness->seen().events,
              HasSubstr("follows what system 255 component 190 has marked: 28 x 24 px"));
  EXPECT_THAT(session->State(), AllOf(HasSubstr("messages sent"), Not(HasSubstr("; target"))))
      << "that is a pad's";
}

// There is nothing to mark.
TEST(GroundStationSession, LandingHasNoCameraToMarkIn) {
  const std::string address = fmt::format("127.0.0.1:{}", FreeLoopbackPort());
  const OpenedLiveSource camera = DrawnSource(3000, PatternImage, 3);
  const auto session =
      MakeSession(camera, LandTask({}), SessionOptions{.autopilot = "udpin://" + address});
  Ground ground(address);
  int calls = 0;
  session->Run([&] {
    ground.SendHeartbeat();
    ground.Receive();
    return ++calls > 15;
  });
  EXPECT_EQ(ground.heartbeats, 0);
}

}  // namespace
}  // namespace kestrel
