// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/sitl/autopilot_model.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/base/error.h"
#include "kestrel/sitl/test_autopilot.h"

namespace kestrel {
namespace {

constexpr double kLongest_s = 90;

// Lands with 50 messages a second; goes on for a while after contact.
template <class MakeMessage>
SitlResult Land(TestAutopilot* autopilot, MakeMessage&& message, double seconds = kLongest_s) {
  autopilot->Run(seconds, [&] { autopilot->Tell(message()); });
  return autopilot->model.result();
}

AutopilotModelOptions WithParameters(const std::string& parameters) {
  AutopilotModelOptions options;
  options.parameters = parameters;
  return options;
}

TEST(ArduPilotLandingTest, LandsOnAStandingPattern) {
  TestAutopilot autopilot(AutopilotFirmware::kArduPilot, {}, TestVehicle("standing", 0));
  const SitlResult result = Land(&autopilot, [&] { return autopilot.ArduPilotTargetMessage(); });
  ASSERT_TRUE(result.contact);
  printf("AP standing %.3f m, landing %.1f s disarm %.1f s\n", result.offset_m(), result.landing_s, result.disarm_s);
  EXPECT_LT(result.offset_m(), 0.05);
  EXPECT_TRUE(result.is_disarmed);
}

class ArduPilotMovingTest : public testing::TestWithParam<double> {};
TEST_P(ArduPilotMovingTest, Lands) {
  TestAutopilot autopilot(AutopilotFirmware::kArduPilot, WithParameters("PLND_OPTIONS=1"),
                          TestVehicle("straight", GetParam()));
  const SitlResult result = Land(&autopilot, [&] { return autopilot.ArduPilotTargetMessage(); });
  ASSERT_TRUE(result.contact);
  printf("AP moving %.3f m, landing %.1f s disarm %.1f s\n", result.offset_m(), result.landing_s, result.disarm_s);
  EXPECT_LT(result.offset_m(), 0.1);
  EXPECT_TRUE(result.is_disarmed);
}
INSTANTIATE_TEST_SUITE_P(Speeds, ArduPilotMovingTest, testing::Values(2.0, 4.2));

TEST(Px4LandingTest, LandsOnAStandingPattern) {
  TestAutopilot autopilot(AutopilotFirmware::kPx4, {}, TestVehicle("standing", 0));
  const SitlResult result = Land(&autopilot, [&] { return autopilot.Px4TargetMessage(); });
  ASSERT_TRUE(result.contact);
  printf("PX4 standing %.3f m, landing %.1f s disarm %.1f s\n", result.offset_m(), result.landing_s, result.disarm_s);
  EXPECT_LT(result.offset_m(), 0.05);
  EXPECT_TRUE(result.is_disarmed);
}

TEST(Px4LandingTest, LandsByTargetRelative) {
  TestAutopilot autopilot(AutopilotFirmware::kPx4, WithParameters("VTE_EN=1"),
                          TestVehicle("standing", 0));
  const SitlResult result = Land(&autopilot, [&] { return autopilot.RelativeMessage(); });
  ASSERT_TRUE(result.contact);
  printf("VTE standing %.3f m, landing %.1f s disarm %.1f s\n", result.offset_m(), result.landing_s, result.disarm_s);
  EXPECT_LT(result.offset_m(), 0.05);
  EXPECT_TRUE(result.is_disarmed);
}

}  // namespace
}  // namespace kestrel
