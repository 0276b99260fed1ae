// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/autopilot_model.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/autopilots/test_autopilot.h"

namespace kestrel {
namespace {

constexpr double kLongest_s = 90;

// Lands with 50 messages per second; continues for a while after contact.
template <class MakeMessage>
SitlResult Land(TestAutopilot* autopilot, MakeMessage&& message, double seconds = kLongest_s) {
  autopilot->Run(seconds, [&] { autopilot->Send(message()); });
  return autopilot->model.result();
}

mavlink::CommandLong Command(std::uint16_t command, const std::array<float, 7>& parameters) {
  mavlink::CommandLong message;
  message.target_system = 1;
  message.command = command;
  message.param1 = parameters[0];
  message.param2 = parameters[1];
  message.param7 = parameters[6];
  return message;
}

AutopilotModelOptions WithParameters(const std::string& parameters) {
  AutopilotModelOptions options;
  options.parameters = parameters;
  return options;
}

TEST(ArduPilotLandingTest, LandsOnStandingPattern) {
  TestAutopilot autopilot(AutopilotFirmware::kArduPilot, {}, TestVehicle("standing", 0));
  const SitlResult result = Land(&autopilot, [&] { return autopilot.ArduPilotTargetMessage(); });
  ASSERT_TRUE(result.contact);
  EXPECT_LT(result.offset_m(), 0.05);
  EXPECT_TRUE(result.is_disarmed);
}

class ArduPilotMovingTest : public testing::TestWithParam<double> {};
TEST_P(ArduPilotMovingTest, Lands) {
  TestAutopilot autopilot(AutopilotFirmware::kArduPilot, WithParameters("PLND_OPTIONS=1"),
                          TestVehicle("straight", GetParam()));
  const SitlResult result = Land(&autopilot, [&] { return autopilot.ArduPilotTargetMessage(); });
  ASSERT_TRUE(result.contact);
  EXPECT_LT(result.offset_m(), 0.1);
  EXPECT_TRUE(result.is_disarmed);
}
INSTANTIATE_TEST_SUITE_P(Speeds, ArduPilotMovingTest, testing::Values(2.0, 4.2));

TEST(Px4LandingTest, LandsOnStandingPattern) {
  TestAutopilot autopilot(AutopilotFirmware::kPx4, {}, TestVehicle("standing", 0));
  const SitlResult result = Land(&autopilot, [&] { return autopilot.Px4TargetMessage(); });
  ASSERT_TRUE(result.contact);
  EXPECT_LT(result.offset_m(), 0.06);  // offset of the feet; PX4 brings the leaning body there
  EXPECT_TRUE(result.is_disarmed);
}

TEST(Px4LandingTest, LandsByTargetRelative) {
  TestAutopilot autopilot(AutopilotFirmware::kPx4, WithParameters("VTE_EN=1"),
                          TestVehicle("standing", 0));
  const SitlResult result = Land(&autopilot, [&] { return autopilot.RelativeMessage(); });
  ASSERT_TRUE(result.contact);
  EXPECT_LT(result.offset_m(), 0.05);
  EXPECT_TRUE(result.is_disarmed);
}

TEST(ArduPilotLandingTest, ReportsStateOfPrecisionLanding) {
  TestAutopilot autopilot(AutopilotFirmware::kArduPilot, {}, TestVehicle("standing", 0));
  autopilot.Run(1, [&] { autopilot.Send(autopilot.ArduPilotTargetMessage()); });
  EXPECT_EQ(autopilot.CountText("PrecLand: Target Found"), 1);
  EXPECT_EQ(autopilot.CountText("PrecLand: Init Complete"), 0);
  autopilot.Run(1.2, [&] { autopilot.Send(autopilot.ArduPilotTargetMessage()); });
  EXPECT_EQ(autopilot.CountText("PrecLand: Init Complete"), 1);
  autopilot.Run(1.9);
  EXPECT_EQ(autopilot.CountText("PrecLand: Target Lost"), 0);
  autopilot.Run(0.3);
  EXPECT_EQ(autopilot.CountText("PrecLand: Target Lost"), 1);
}

TEST(ArduPilotLandingTest, OneTargetPerSecondIsNotEnough) {
  TestAutopilot autopilot(AutopilotFirmware::kArduPilot, {}, TestVehicle("standing", 0));
  for (int i = 0; i < 5; ++i) {
    autopilot.Send(autopilot.ArduPilotTargetMessage());
    autopilot.Run(1);
  }
  EXPECT_GE(autopilot.CountText("PrecLand: Init Failed"), 4);
  EXPECT_EQ(autopilot.CountText("PrecLand: Init Complete"), 0);
}

TEST(ArduPilotLandingTest, RefusesOtherFramesWithOneMessage) {
  TestAutopilot autopilot(AutopilotFirmware::kArduPilot, {}, TestVehicle("standing", 0));
  autopilot.Run(3, [&] { autopilot.Send(autopilot.Px4TargetMessage()); });
  EXPECT_EQ(autopilot.CountText("Plnd: Frame not supported"), 1);
  EXPECT_EQ(autopilot.CountText("PrecLand"), 0);
}

TEST(ArduPilotLandingTest, IgnoresTargetsWithoutDistance) {
  TestAutopilot autopilot(AutopilotFirmware::kArduPilot, {}, TestVehicle("standing", 0));
  autopilot.Run(3, [&] {
    mavlink::LandingTarget message = autopilot.ArduPilotTargetMessage();
    message.distance = 0;
    autopilot.Send(message);
    message.position_valid = 0;
    autopilot.Send(message);
  });
  EXPECT_EQ(autopilot.CountText(""), 0);
}

TEST(ArduPilotLandingTest, LandsBesideWhenTargetIsLost) {
  TestAutopilot autopilot(AutopilotFirmware::kArduPilot, {}, TestVehicle("standing", 0));
  const SitlResult result = Land(&autopilot, [] { return mavlink::Heartbeat(); });
  EXPECT_TRUE(result.contact);
  EXPECT_TRUE(result.is_disarmed);
  EXPECT_GT(result.offset_m(), 1.5);
}

TEST(ArduPilotLandingTest, HoversAtPlaceOfLossWithStrictTwo) {
  TestAutopilot autopilot(AutopilotFirmware::kArduPilot, WithParameters("PLND_STRICT=2"),
                          TestVehicle("standing", 0));
  autopilot.Run(15, [&] { autopilot.Send(autopilot.ArduPilotTargetMessage()); });
  autopilot.Run(60);
  EXPECT_FALSE(autopilot.model.result().contact);
}

TEST(ArduPilotLandingTest, TrailsMovingTargetWithoutOptionBit0) {
  TestAutopilot autopilot(AutopilotFirmware::kArduPilot, {}, TestVehicle("straight", 2));
  autopilot.Run(20, [&] { autopilot.Send(autopilot.ArduPilotTargetMessage()); });
  EXPECT_NEAR(autopilot.HorizontalError(), 2.1, 0.4) << "measured: 2.2 m";
}

TEST(ArduPilotLandingTest, OscillatesWithUnconfiguredLag) {
  const auto rms_by = [](const std::string& parameters) {
    TestAutopilot autopilot(AutopilotFirmware::kArduPilot, WithParameters(parameters),
                            TestVehicle("straight", 2));
    std::vector<mavlink::LandingTarget> late;
    double sum = 0;
    int count = 0;
    autopilot.Run(20, [&] {
      late.push_back(autopilot.ArduPilotTargetMessage());
      constexpr std::size_t kDelay = 10;  // messages, 20 ms apart
      if (late.size() > kDelay) autopilot.Send(late[late.size() - 1 - kDelay]);
      if (autopilot.now < kTestStart + std::chrono::seconds(10)) return;
      sum += autopilot.HorizontalError() * autopilot.HorizontalError();
      ++count;
    });
    return std::sqrt(sum / count);
  };
  const double right = rms_by("PLND_OPTIONS=1,PLND_LAG=0.2");
  const double wrong = rms_by("PLND_OPTIONS=1,PLND_LAG=0.02");
  EXPECT_LT(right, 0.15);
  EXPECT_GT(wrong, 0.3) << "measured: 0.5 m";
}

TEST(ArduPilotLandingTest, DisarmsOnMovingDeckOnlyWhileTargetsContinue) {
  TestAutopilot autopilot(AutopilotFirmware::kArduPilot, WithParameters("PLND_OPTIONS=1"),
                          TestVehicle("straight", 2));
  const SitlResult result = Land(&autopilot, [&]() -> CompanionMessage {
    if (autopilot.model.result().contact) return mavlink::Heartbeat();
    return autopilot.ArduPilotTargetMessage();
  });
  ASSERT_TRUE(result.contact);
  EXPECT_FALSE(result.is_disarmed);
  EXPECT_TRUE(autopilot.model.is_armed());
}

TEST(Px4LandingTest, RefusesBodyFramesWithMessageToGroundStation) {
  for (const bool has_gcs : {false, true}) {
    TestAutopilot autopilot(AutopilotFirmware::kPx4, {}, TestVehicle("standing", 0));
    if (has_gcs) autopilot.Send(mavlink::Heartbeat{.type = mavlink::kTypeGcs});
    const SitlResult result = Land(&autopilot, [&] { return autopilot.ArduPilotTargetMessage(); });
    EXPECT_EQ(autopilot.CountText("landing target: coordinate frame 12 unsupported") > 100,
              has_gcs);
    ASSERT_TRUE(result.contact) << "searches, then lands anyway";
    EXPECT_GT(result.offset_m(), 1.5);
  }
}

TEST(Px4LandingTest, NeverCatchesMovingPad) {
  TestAutopilot autopilot(AutopilotFirmware::kPx4, {}, TestVehicle("straight", 4.2));
  const SitlResult result = Land(
      &autopilot, [&] { return autopilot.Px4TargetMessage(); }, /*seconds=*/60);
  EXPECT_FALSE(result.contact);
  EXPECT_GT(autopilot.HorizontalError(), 5);
}

TEST(Px4LandingTest, RefusesFutureStampsAndStampsOfAnotherClock) {
  for (const std::int64_t error_us : {300'000, 1'000'000'000, -700'000}) {
    TestAutopilot autopilot(AutopilotFirmware::kPx4, WithParameters("VTE_EN=1"),
                            TestVehicle("standing", 0));
    autopilot.Send(mavlink::Heartbeat{.type = mavlink::kTypeGcs});
    const SitlResult result = Land(&autopilot, [&] {
      mavlink::TargetRelative message = autopilot.RelativeMessage();
      message.timestamp += error_us;
      return message;
    });
    EXPECT_GT(autopilot.CountText("Vision data too old"), 1);
    EXPECT_GT(result.offset_m(), 1.5);
  }
}

TEST(Px4LandingTest, DisarmsBySpeedLimitOfLandDetector) {
  for (const bool raised : {false, true}) {
    const std::string parameters = raised ? "LNDMC_XY_VEL_MAX=5,VTE_EN=1" : "VTE_EN=1";
    AutopilotModelOptions options = WithParameters(parameters);
    options.pilot.offset_east_m = 0;
    options.pilot.offset_north_m = 0;
    TestAutopilot autopilot(AutopilotFirmware::kPx4, options, TestVehicle("straight", 2));
    const SitlResult result = Land(&autopilot, [&] { return autopilot.RelativeMessage(); });
    ASSERT_TRUE(result.contact);
    EXPECT_EQ(result.is_disarmed, raised);
  }
}

// PX4 converts stamps only after it has synchronised. They then have to be on the clock that
// answered its requests.
TEST(Px4LandingTest, ReadsStampsOnClockThatAnswersTimesync) {
  TestAutopilot autopilot(AutopilotFirmware::kPx4, {}, TestVehicle("standing", 0));
  const std::int64_t companion_ns = 1'000'000'000'000;
  Px4TimeSync sync;
  for (std::int64_t i = 0; i < 499; ++i) sync.AddAnswer(i, i + companion_ns / 1000, i + 1000);
  EXPECT_EQ(sync.OwnTime(5, 77), 77);
  sync.AddAnswer(499, 499 + companion_ns / 1000, 1499);
  ASSERT_TRUE(sync.is_converged());
  EXPECT_NEAR(sync.OwnTime(companion_ns / 1000 + 2000, 77), 2500, 1);
  sync.AddAnswer(0, 0, 20'000);
  EXPECT_NEAR(sync.OwnTime(companion_ns / 1000 + 2000, 77), 2500, 1) << "too slow to count";
}

TEST(AutopilotModelTest, ArduPilotSendsRequestedStreamsOnly) {
  TestAutopilot autopilot(AutopilotFirmware::kArduPilot, {}, TestVehicle("standing", 0));
  autopilot.Run(2);
  EXPECT_EQ(autopilot.Sent<mavlink::Heartbeat>().size(), 2);
  EXPECT_EQ(autopilot.Sent<mavlink::Attitude>().size(), 0);
  const auto request = [&](float id, float interval_us) {
    autopilot.Send(Command(mavlink::kCommandSetMessageInterval, {id, interval_us}));
    return autopilot.Sent<mavlink::CommandAck>().back().result;
  };
  EXPECT_EQ(request(mavlink::Attitude::kId, 20000), mavlink::kResultAccepted);
  EXPECT_EQ(request(mavlink::SimState::kId, 10000), mavlink::kResultAccepted);
  EXPECT_EQ(request(mavlink::Attitude::kId, 1000), mavlink::kResultDenied);
  EXPECT_EQ(request(12345, 20000), mavlink::kResultDenied);
  autopilot.Run(2);
  EXPECT_NEAR(autopilot.Sent<mavlink::Attitude>().size(), 100, 2);
  EXPECT_NEAR(autopilot.Sent<mavlink::SimState>().size(), 200, 3);
}

TEST(AutopilotModelTest, Px4SendsItsOnboardStreams) {
  TestAutopilot autopilot(AutopilotFirmware::kPx4, {}, TestVehicle("standing", 0));
  autopilot.Run(2);
  EXPECT_NEAR(autopilot.Sent<mavlink::Attitude>().size(), 200, 3);
  EXPECT_NEAR(autopilot.Sent<mavlink::LocalPositionNed>().size(), 60, 2);
  EXPECT_NEAR(autopilot.Sent<mavlink::Timesync>().size(), 20, 1);
  autopilot.Send(Command(mavlink::kCommandSetMessageInterval, {mavlink::SimState::kId, 20000}));
  EXPECT_EQ(autopilot.Sent<mavlink::CommandAck>().back().result, mavlink::kResultFailed);
}

TEST(AutopilotModelTest, ReportsPoseInNedAndFrd) {
  AutopilotModelOptions options;
  options.pilot.heading_deg = 60;
  options.pilot.land_after_s = -1;
  TestAutopilot autopilot(AutopilotFirmware::kPx4, options, TestVehicle("standing", 0));
  autopilot.Run(1);
  EXPECT_NEAR(autopilot.Sent<mavlink::Attitude>().back().yaw, 60 * kPi / 180, 0.02);
  const auto position = autopilot.Sent<mavlink::LocalPositionNed>().back();
  const Eigen::Vector3d& truth = autopilot.model.truth().world_from_body.translation;
  EXPECT_NEAR(position.x, truth.y(), 0.05);
  EXPECT_NEAR(position.y, truth.x(), 0.05);
  EXPECT_NEAR(position.z, -truth.z(), 0.05);
  const auto q = autopilot.Sent<mavlink::AttitudeQuaternion>().back();
  EXPECT_NEAR(std::remainder(2 * std::atan2(q.q4, q.q1), 2 * kPi), 60 * kPi / 180, 0.02);
  const auto global = autopilot.Sent<mavlink::GlobalPositionInt>().back();
  EXPECT_EQ(global.hdg / 200, 30);
  EXPECT_NEAR(1e-7 * global.lat, 47.397742 + truth.y() / 111'319.5, 2e-6);
}

TEST(AutopilotModelTest, AnswersTimesyncByItsOwnClock) {
  AutopilotModelOptions options;
  options.drift_ppm = 50;
  options.uptime_s = 30;
  TestAutopilot autopilot(AutopilotFirmware::kArduPilot, options, TestVehicle("standing", 0));
  autopilot.Run(100);
  autopilot.Send(mavlink::Timesync{.tc1 = 0, .ts1 = 123456789});
  const auto answer = autopilot.Sent<mavlink::Timesync>().back();
  EXPECT_EQ(answer.ts1, 123456789);
  EXPECT_NEAR(1e-9 * static_cast<double>(answer.tc1), 130.005, 1e-6);
}

TEST(AutopilotModelTest, RebootRestartsClockAndStreams) {
  TestAutopilot autopilot(AutopilotFirmware::kPx4, {}, TestVehicle("standing", 0));
  autopilot.Run(1);
  autopilot.model.Reboot(autopilot.now);
  autopilot.sent.clear();
  autopilot.Run(2.5);
  EXPECT_TRUE(autopilot.sent.empty());
  autopilot.Run(1);
  ASSERT_FALSE(autopilot.Sent<mavlink::Attitude>().empty());
  EXPECT_LT(autopilot.Sent<mavlink::Attitude>().back().time_boot_ms, 4000);
}

TEST(AutopilotModelTest, SendsPx4IntegersAsBits) {
  for (const auto firmware : {AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4}) {
    const bool is_px4 = firmware == AutopilotFirmware::kPx4;
    TestAutopilot autopilot(firmware, {}, TestVehicle("standing", 0));
    const auto name = CharsOf<16>(is_px4 ? "LTEST_SENS_ROT" : "PLND_ENABLED");
    autopilot.Send(mavlink::ParamRequestRead{
        .target_system = 1, .target_component = 1, .param_id = name, .param_index = -1});
    ASSERT_EQ(autopilot.Sent<mavlink::ParamValue>().size(), 1);
    const float value = autopilot.Sent<mavlink::ParamValue>()[0].param_value;
    EXPECT_EQ(value, is_px4 ? std::bit_cast<float>(2) : 1.0f);
    mavlink::ParamSet set;
    set.target_system = 1;
    set.param_id = name;
    set.param_type = mavlink::kParamInt32;
    set.param_value = is_px4 ? std::bit_cast<float>(5) : 5.0f;
    autopilot.Send(set);
    EXPECT_EQ(autopilot.model.parameters()[is_px4 ? "LTEST_SENS_ROT" : "PLND_ENABLED"], 5);
  }
}

TEST(AutopilotModelTest, FollowsCommands) {
  AutopilotModelOptions options;
  options.pilot.start_altitude_m = 0;
  TestAutopilot autopilot(AutopilotFirmware::kArduPilot, options, TestVehicle("circle", 2));
  const auto command = [&](std::uint16_t number, float p1, float p2 = 0, float p7 = 0) {
    autopilot.Send(Command(number, {p1, p2, 0, 0, 0, 0, p7}));
    return autopilot.Sent<mavlink::CommandAck>().back().result;
  };
  constexpr std::uint16_t kTakeOff = 22;
  EXPECT_EQ(command(kTakeOff, 0, 0, 6), mavlink::kResultFailed) << "not armed";
  EXPECT_EQ(command(mavlink::kCommandDoSetMode, 1, 4), mavlink::kResultAccepted);
  EXPECT_EQ(command(mavlink::kCommandDoSetMode, 1, 77), mavlink::kResultFailed);
  EXPECT_EQ(command(mavlink::kCommandArmDisarm, 1), mavlink::kResultAccepted);
  EXPECT_EQ(command(kTakeOff, 0, 0, 6), mavlink::kResultAccepted);
  autopilot.Run(12);
  EXPECT_EQ(autopilot.Sent<mavlink::Heartbeat>().back().custom_mode, 4);
  EXPECT_NEAR(autopilot.model.truth().world_from_body.translation.z(), 6, 0.3);
  EXPECT_EQ(command(mavlink::kCommandArmDisarm, 0), mavlink::kResultFailed) << "in flight";
  EXPECT_EQ(command(mavlink::kCommandDoSetMode, 1, 9), mavlink::kResultAccepted);
  autopilot.Run(30);
  EXPECT_FALSE(autopilot.model.is_armed());
  EXPECT_FALSE(autopilot.model.result().contact->on_board);
}

TEST(AutopilotModelTest, StopsMotorsInFlightByForcedDisarm) {
  TestAutopilot autopilot(AutopilotFirmware::kPx4, {}, TestVehicle("standing", 0));
  autopilot.Run(1);
  autopilot.Send(Command(mavlink::kCommandArmDisarm, {0, 21196}));
  autopilot.Run(3);
  EXPECT_FALSE(autopilot.model.is_armed());
  EXPECT_LT(autopilot.model.truth().world_from_body.translation.z(), 1);
}

TEST(AutopilotModelTest, DropsMessagesWithItsOwnIds) {
  TestAutopilot autopilot(AutopilotFirmware::kArduPilot, {}, TestVehicle("standing", 0));
  autopilot.model.Handle(mavlink::Timesync{.ts1 = 5}, 1, 1, autopilot.now);
  EXPECT_TRUE(autopilot.sent.empty());
}

TEST(AutopilotModelTest, RefusesUnknownParameters) {
  for (const char* parameters : {"PLD_HACC_RAD=2", "PLND_LAG", "PLND_LAG=x"}) {
    EXPECT_THROW(TestAutopilot(AutopilotFirmware::kArduPilot, WithParameters(parameters),
                               TestVehicle("standing", 0)),
                 InputError);
  }
}

}  // namespace
}  // namespace kestrel
