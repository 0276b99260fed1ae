// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/packet_parser.h"

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/message_table.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/packet_writer.h"
#include "kestrel/comms/mavlink/test_link.h"

namespace kestrel::mavlink {
namespace {

// A LANDING_TARGET of node-mavlink (system 42, component 191, sequence 7).
const std::vector<std::uint8_t> kLandingTarget = BytesOfHex(
    "fd3c0000072abf950000d202964900000000cdcccc3dcdcc4cbd0000a040cdcccc3dcdcccc3d000c0000003f00008"
    "03ecdcc9c400000803f00000000000000000000000003016583");

std::vector<std::uint8_t> FrameOf(const auto& message) {
  PacketWriter writer(1, 191);
  const auto frame = writer.Write(message);
  return {frame.begin(), frame.end()};
}

std::vector<Packet> PacketsIn(std::span<const std::uint8_t> bytes, std::size_t chunk = 10000) {
  PacketParser parser;
  std::vector<Packet> packets;
  for (std::size_t i = 0; i < bytes.size(); i += chunk) {
    parser.Parse(bytes.subspan(i, std::min(chunk, bytes.size() - i)),
                 [&](const Packet& packet) { packets.push_back(packet); });
  }
  return packets;
}

void Append(const std::vector<std::uint8_t>& more, std::vector<std::uint8_t>* bytes) {
  bytes->insert(bytes->end(), more.begin(), more.end());
}

TEST(PacketParserTest, ReadsPacketOfAnotherImplementation) {
  const auto packets = PacketsIn(kLandingTarget);
  ASSERT_EQ(packets.size(), 1u);
  EXPECT_EQ(packets[0].system, 42);
  EXPECT_EQ(packets[0].component, 191);
  EXPECT_EQ(packets[0].sequence, 7);
  const auto target = packets[0].As<LandingTarget>();
  ASSERT_TRUE(target);
  EXPECT_EQ(target->time_usec, 1234567890u);
  EXPECT_EQ(target->frame, 12);
  EXPECT_FLOAT_EQ(target->angle_y, -0.05f);
  EXPECT_FLOAT_EQ(target->distance, 5);
  EXPECT_FLOAT_EQ(target->z, 4.9f);
  EXPECT_FLOAT_EQ(target->q[0], 1);
  EXPECT_EQ(target->type, 3);
  EXPECT_EQ(target->position_valid, 1);
  EXPECT_FALSE(packets[0].As<Heartbeat>());
}

TEST(PacketWriterTest, WritesSamePacketAsAnotherImplementation) {
  const auto target = PacketsIn(kLandingTarget).at(0).As<LandingTarget>();
  PacketWriter writer(42, 191);
  for (int i = 0; i < 7; ++i) writer.Write(Heartbeat{});
  const auto frame = writer.Write(*target);
  EXPECT_EQ(std::vector<std::uint8_t>(frame.begin(), frame.end()), kLandingTarget);
}

TEST(PacketWriterTest, TrimsTrailingZeros) {
  Attitude attitude;
  attitude.time_boot_ms = 3;
  const auto frame = FrameOf(attitude);
  EXPECT_EQ(frame.size(), kHeaderSize2 + 1 + kChecksumSize);
  const auto packets = PacketsIn(frame);
  ASSERT_EQ(packets.size(), 1u);
  EXPECT_EQ(packets[0].As<Attitude>()->time_boot_ms, 3u);
  EXPECT_EQ(packets[0].As<Attitude>()->yawspeed, 0);
  EXPECT_EQ(PacketsIn(FrameOf(Attitude{})).at(0).payload_size, 1u);
}

TEST(PacketParserTest, ReadsMavlink1) {
  const auto bytes = BytesOfHex("fe0900010100000000000203510403");
  std::vector<std::uint8_t> frame(bytes);
  Crc crc;
  crc.Add(std::span<const std::uint8_t>(frame).subspan(1));
  crc.Add(kLayout<Heartbeat>.crc_extra);
  frame.push_back(crc.value() & 0xff);
  frame.push_back(crc.value() >> 8);
  const auto packets = PacketsIn(frame);
  ASSERT_EQ(packets.size(), 1u);
  EXPECT_EQ(packets[0].system, 1);
  EXPECT_EQ(packets[0].As<Heartbeat>()->type, 2);
  EXPECT_EQ(packets[0].As<Heartbeat>()->autopilot, 3);
  EXPECT_EQ(packets[0].As<Heartbeat>()->mavlink_version, 3);
}

TEST(PacketParserTest, FindsPacketsByteByByteBetweenGarbage) {
  std::mt19937 random(1);
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < 200; ++i) {
    for (std::size_t n = random() % 40; n > 0; --n) bytes.push_back(random() % 0xfd);
    Append(kLandingTarget, &bytes);
  }
  EXPECT_EQ(PacketsIn(bytes).size(), 200u);
  EXPECT_EQ(PacketsIn(bytes, 1).size(), 200u);
  EXPECT_EQ(PacketsIn(bytes, 7).size(), 200u);
}

TEST(PacketParserTest, FindsPacketAfterTruncatedOne) {
  std::vector<std::uint8_t> bytes(kLandingTarget.begin(), kLandingTarget.begin() + 20);
  for (int i = 0; i < 3; ++i) Append(kLandingTarget, &bytes);
  EXPECT_EQ(PacketsIn(bytes).size(), 3u);
}

TEST(PacketParserTest, CountsWrongChecksums) {
  std::vector<std::uint8_t> bytes = kLandingTarget;
  bytes[30] ^= 1;
  PacketParser parser;
  parser.Parse(bytes, [](const Packet&) { FAIL(); });
  EXPECT_EQ(parser.bad_checksums(), 1u);
  EXPECT_GT(parser.skipped_bytes(), 10u);
}

TEST(PacketParserTest, SkipsUnknownMessages) {
  std::vector<std::uint8_t> bytes = kLandingTarget;
  bytes[7] = 0xe7;
  bytes[8] = 0x7;
  Append(kLandingTarget, &bytes);
  const auto packets = PacketsIn(bytes);
  ASSERT_EQ(packets.size(), 2u);
  EXPECT_FALSE(packets[0].is_known);
  EXPECT_TRUE(packets[1].is_known);
}

TEST(PacketParserTest, RefusesUnknownIncompatibilities) {
  std::vector<std::uint8_t> bytes = kLandingTarget;
  bytes[2] = 0x02;
  EXPECT_TRUE(PacketsIn(bytes).empty());
}

TEST(PacketParserTest, TruncatedDatagramDoesNotDelayNext) {
  PacketParser parser;
  int found = 0;
  const auto count = [&](const Packet&) { ++found; };
  parser.Parse(std::span(kLandingTarget).first(20), count);
  parser.EndDatagram(count);
  parser.Parse(FrameOf(Heartbeat{}), count);
  EXPECT_EQ(found, 1);
}

TEST(MessageTableTest, KnowsItsMessages) {
  EXPECT_EQ(KnownMessages().size(), 54u);
  ASSERT_NE(FindMessage(511), nullptr);
  EXPECT_EQ(FindMessage(511)->name, "TARGET_RELATIVE");
  EXPECT_EQ(FindMessage(3), nullptr);
}

}  // namespace
}  // namespace kestrel::mavlink
