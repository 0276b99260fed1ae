// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/recorded_autopilot.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/test_telemetry_log.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr Time kBegin(1000s);
constexpr Time kEnd(1010s);
constexpr std::uint32_t kLoiter = 5, kLand = 9;
constexpr std::uint8_t kKestrel = 191;

std::string FactOf(const ConsoleVehicle& vehicle, const std::string& name) {
  for (const ConsoleCheck& fact : vehicle.facts) {
    if (fact.name == name) return fact.measured;
  }
  return "";
}

class RecordedAutopilotTest : public testing::Test {
 protected:
  RecordedAutopilotTest() { std::filesystem::create_directories(folder_ / "mav0/cam0"); }
  // UTC, which is 1.7e9 s ahead of the recording's time.
  static std::int64_t Utc_us(double at_s) {
    return static_cast<std::int64_t>(1e6 * (1'700'001'000 + at_s));
  }
  template <class Message>
  void Report(double at_s, const Message& message) {
    log_.Add(Utc_us(at_s), message);
  }
  // Kestrel requests the autopilot's clock, and the other way round.
  void RequestTime(double at_s) {
    mavlink::Timesync question;
    question.ts1 = ToNanoseconds(kBegin + DurationFromSeconds(at_s));
    log_.Add(Utc_us(at_s), question, kKestrel);
    question.ts1 = ToNanoseconds(kBegin + 7s);
    Report(at_s, question);
  }
  void SendHeartbeat(double at_s, std::uint32_t mode, bool is_armed) {
    Report(at_s,
           mavlink::Heartbeat{mavlink::kTypeQuadrotor, mavlink::kAutopilotArduPilot,
                              is_armed ? mavlink::kModeFlagArmed : std::uint8_t{0}, mode, 4, 3});
  }
  void SendBattery(double at_s, double volts, int percent) {
    mavlink::SysStatus status;
    status.voltage_battery = static_cast<std::uint16_t>(1e3 * volts);
    status.battery_remaining = static_cast<std::int8_t>(percent);
    Report(at_s, status);
  }
  void SendText(double at_s, std::uint8_t severity, std::string_view text) {
    mavlink::Statustext message;
    message.severity = severity;
    std::copy(text.begin(), text.end(), message.text.begin());
    Report(at_s, message);
  }

  // From 1 s on in LOITER, from 6 s on in LAND, with a text between.
  void Fly() {
    RequestTime(0);
    for (int second = 1; second <= 10; ++second) {
      SendBattery(second - 0.1, 12.5, 80 - second);
      SendHeartbeat(second, second < 6 ? kLoiter : kLand, second < 9);
      RequestTime(second + 0.5);
      if (second == 5) SendText(5.75, mavlink::kSeverityWarning, "PrecLand: Target Lost");
    }
  }

  RecordedAutopilot Read() {
    folder_.Write("mavlink.tlog", log_.bytes());
    return ReadRecordedAutopilot({folder_.path()}, kBegin, kEnd);
  }

  TestFolder folder_;
  TestTelemetryLog log_;
};

TEST_F(RecordedAutopilotTest, ShowsModeMotorsAndBatteryOfEachTime) {
  Fly();
  const RecordedAutopilot autopilot = Read();
  EXPECT_EQ(autopilot.fault, "");
  EXPECT_EQ(FactOf(autopilot.At(kBegin), "mode"), "not recorded");
  EXPECT_EQ(FactOf(autopilot.At(kBegin + 4s), "mode"), "LOITER");
  EXPECT_EQ(FactOf(autopilot.At(kBegin + 4s), "motors"), "armed");
  EXPECT_EQ(FactOf(autopilot.At(kBegin + 4500ms), "battery"), "12.5 V, 76 %");
  EXPECT_EQ(FactOf(autopilot.At(kBegin + 7s), "mode"), "LAND");
  EXPECT_EQ(FactOf(autopilot.At(kBegin + 9700ms), "motors"), "disarmed");
  EXPECT_EQ(FactOf(autopilot.At(kBegin + 20s), "mode"), "not recorded");
}

TEST_F(RecordedAutopilotTest, ListsTextsAndChangesAtTheirTimes) {
  Fly();
  const RecordedAutopilot autopilot = Read();
  const auto is = [](Duration at, EventLevel level, const std::string& text) {
    return AllOf(Field(&SessionEvent::time, kBegin + at), Field(&SessionEvent::level, level),
                 Field(&SessionEvent::text, text));
  };
  EXPECT_THAT(autopilot.events,
              ElementsAre(is(1s, EventLevel::kInfo, "ArduPilot (system 1) heard, LOITER, armed"),
                          is(5750ms, EventLevel::kWarning, "autopilot: PrecLand: Target Lost"),
                          is(6s, EventLevel::kInfo, "mode LAND, armed"),
                          is(9s, EventLevel::kInfo, "mode LAND, disarmed")));
}

TEST_F(RecordedAutopilotTest, ShowsMissingHeartbeats) {
  RequestTime(0);
  SendHeartbeat(1, kLoiter, true);
  SendBattery(1.5, 12.5, 80);
  for (int second = 2; second < 8; ++second) RequestTime(second);
  SendHeartbeat(8, kLand, true);
  RequestTime(9);
  const RecordedAutopilot autopilot = Read();
  EXPECT_EQ(FactOf(autopilot.At(kBegin + 2s), "mode"), "LOITER");
  EXPECT_EQ(FactOf(autopilot.At(kBegin + 5s), "mode"), "no heartbeat");
  EXPECT_EQ(FactOf(autopilot.At(kBegin + 5s), "battery"), "");
  EXPECT_EQ(FactOf(autopilot.At(kBegin + 9s), "mode"), "LAND");
}

TEST_F(RecordedAutopilotTest, ShowsReadablePartOfDamagedLog) {
  Fly();
  std::string& bytes = log_.bytes();
  bytes.resize(bytes.size() - 5);
  const std::string half = bytes.substr(0, bytes.size() / 2);
  bytes = half + std::string(200, '\x55') + bytes.substr(half.size());
  const RecordedAutopilot autopilot = Read();
  EXPECT_EQ(FactOf(autopilot.At(kBegin + 2s), "mode"), "LOITER");
  EXPECT_EQ(FactOf(autopilot.At(kBegin + 8s), "mode"), "LAND");
  EXPECT_THAT(autopilot.fault, AllOf(HasSubstr("mavlink.tlog: "), Not(HasSubstr("\n")),
                                     EndsWith("are damaged or cut off: the rest is shown")));
  ASSERT_THAT(autopilot.events, Not(IsEmpty()));
  EXPECT_EQ(autopilot.events.front().text, autopilot.fault);
  EXPECT_EQ(autopilot.events.front().level, EventLevel::kWarning);
}

TEST_F(RecordedAutopilotTest, ReportsWhyLogIsNotShown) {
  SendHeartbeat(1, kLand, true);
  const RecordedAutopilot autopilot = Read();
  EXPECT_THAT(autopilot.states, IsEmpty());
  EXPECT_THAT(autopilot.fault, HasSubstr("has no TIMESYNC of Kestrel"));
}

TEST_F(RecordedAutopilotTest, IsEmptyWithoutLog) {
  const RecordedAutopilot autopilot = ReadRecordedAutopilot({folder_.path()}, kBegin, kEnd);
  EXPECT_THAT(autopilot.states, IsEmpty());
  EXPECT_THAT(autopilot.events, IsEmpty());
  EXPECT_EQ(autopilot.fault, "");
  EXPECT_THAT(ReadRecordedAutopilot({"video.mp4"}, kBegin, kEnd).states, IsEmpty());
}

}  // namespace
}  // namespace kestrel
