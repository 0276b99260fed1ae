// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/telemetry_log.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/test_telemetry_log.h"

namespace kestrel {
namespace {

using mavlink::Packet;
using testing::ElementsAre;
using testing::IsEmpty;

// Three heartbeats a second apart.
std::string ThreeHeartbeats() {
  TestTelemetryLog log;
  for (std::uint32_t mode = 0; mode < 3; ++mode) {
    mavlink::Heartbeat heartbeat;
    heartbeat.custom_mode = mode;
    log.Add(1'700'000'000'000'000 + 1'000'000 * std::int64_t{mode}, heartbeat);
  }
  return log.bytes();
}

struct Reading {
  std::vector<std::uint32_t> modes;
  std::vector<std::int64_t> times_us;
  std::size_t skipped = 0;
};

Reading Read(const std::string& log) {
  Reading reading;
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(log.data());
  reading.skipped =
      mavlink::ReadTelemetryLog({bytes, log.size()}, [&](const Packet& packet, std::int64_t time) {
        const auto heartbeat = packet.As<mavlink::Heartbeat>();
        if (!heartbeat) return;  // the id is damaged: its checksum cannot be checked
        reading.modes.push_back(heartbeat->custom_mode);
        reading.times_us.push_back(time);
      });
  return reading;
}

TEST(TelemetryLogTest, ReadsPacketsWithTimes) {
  const Reading reading = Read(ThreeHeartbeats());
  EXPECT_THAT(reading.modes, ElementsAre(0, 1, 2));
  EXPECT_THAT(reading.times_us,
              ElementsAre(1'700'000'000'000'000, 1'700'000'001'000'000, 1'700'000'002'000'000));
  EXPECT_EQ(reading.skipped, 0u);
  EXPECT_THAT(Read("").modes, IsEmpty());
}

TEST(TelemetryLogTest, ReadsPacketsBeforeTruncation) {
  const std::string log = ThreeHeartbeats();
  const std::size_t record = log.size() / 3;
  for (std::size_t missing = 1; missing < record; ++missing) {
    const Reading reading = Read(log.substr(0, log.size() - missing));
    EXPECT_THAT(reading.modes, ElementsAre(0, 1)) << missing;
    EXPECT_EQ(reading.skipped, record - missing);
  }
}

TEST(TelemetryLogTest, ContinuesAfterDamage) {
  const std::string whole = ThreeHeartbeats();
  const std::size_t record = whole.size() / 3;
  constexpr std::size_t kTimeSize = 8;
  for (std::size_t i = record + kTimeSize; i < 2 * record; ++i) {
    std::string log = whole;
    log[i] = static_cast<char>(~log[i]);
    EXPECT_THAT(Read(log).modes, ElementsAre(0, 2)) << i;
  }
  std::string log = whole;
  log[2 * record - 1] = static_cast<char>(~log[2 * record - 1]);  // the checksum
  EXPECT_EQ(Read(log).skipped, record);
  const Reading inserted =
      Read(whole.substr(0, record) + std::string(100, '\xfd') + whole.substr(record));
  EXPECT_THAT(inserted.modes, ElementsAre(0, 1, 2));
  EXPECT_EQ(inserted.skipped, 100u);
}

}  // namespace
}  // namespace kestrel
