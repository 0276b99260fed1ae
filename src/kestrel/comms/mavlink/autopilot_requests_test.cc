// SPDX-License-Identifier: BSD-3-Clause
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/test_autopilot.h"

namespace kestrel {
namespace {

TEST_F(AutopilotTest, ReadsParametersOfBothKinds) {
  Start();
  autopilot_->parameters().Want("PLND_ENABLED");
  autopilot_->parameters().Want("NO_SUCH");
  Pass(1);
  const auto read = last_heard_[mavlink::ParamRequestRead::kId].As<mavlink::ParamRequestRead>();
  EXPECT_EQ(read->param_index, -1);
  mavlink::ParamValue value;
  SetText("PLND_ENABLED", value.param_id);
  value.param_value = 1;
  value.param_type = 2;
  SendMessage(value);
  EXPECT_EQ(autopilot_->parameters().Find("PLND_ENABLED"), 1);
  Pass(7);
  EXPECT_TRUE(autopilot_->parameters().IsMissing("NO_SUCH"));
  EXPECT_TRUE(autopilot_->parameters().is_done());
  value.param_type = mavlink::kParamInt32;
  const std::int32_t bits = 2;
  std::memcpy(&value.param_value, &bits, sizeof(bits));
  EXPECT_EQ(ParameterValue(AutopilotKind::kPx4, value), 2);
}

mavlink::ParamValue ValueOf(const char* name, float value, std::uint8_t type) {
  mavlink::ParamValue message;
  SetText(name, message.param_id);
  message.param_value = value;
  message.param_type = type;
  return message;
}

TEST_F(AutopilotTest, ParameterHasTypedValue) {
  for (const double typed : {0.3, 4.2, 0.05, 1e6, -12.5}) {
    const auto value = ValueOf("GUID_TIMEOUT", static_cast<float>(typed), 9);
    EXPECT_EQ(ParameterValue(AutopilotKind::kArduPilot, value), typed);
  }
  const auto nan = ValueOf("GUID_TIMEOUT", std::numeric_limits<float>::quiet_NaN(), 9);
  EXPECT_TRUE(std::isnan(ParameterValue(AutopilotKind::kArduPilot, nan)));
}

TEST_F(AutopilotTest, ReadsParameterByAllItsNames) {
  Start();
  autopilot_->parameters().Want("WP_SPD");
  autopilot_->parameters().Want("GUID_TIMEOUT");
  Pass(1);
  EXPECT_EQ(heard_[mavlink::ParamRequestRead::kId], 3);
  SendMessage(ValueOf("WPNAV_SPEED", 1200, mavlink::kParamReal32));
  EXPECT_EQ(autopilot_->parameters().Find("WP_SPD"), 12) << "in m/s, as 4.7 has it";
  EXPECT_EQ(autopilot_->parameters().EntryOf("WP_SPD")->name, "WPNAV_SPEED");
  EXPECT_FALSE(autopilot_->parameters().Find("GUID_TIMEOUT"));
}

TEST_F(AutopilotTest, WritesParameterUntilAcknowledged) {
  Start();
  Pass(1);
  autopilot_->SetParameter("WP_SPD", 8);
  Pass(1);
  EXPECT_EQ(heard_[mavlink::ParamSet::kId], 0) << "its type is not known yet";
  SendMessage(ValueOf("WPNAV_SPEED", 1200, mavlink::kParamReal32));
  Pass(1.2);
  EXPECT_GT(heard_[mavlink::ParamSet::kId], 1);
  const auto set = last_heard_[mavlink::ParamSet::kId].As<mavlink::ParamSet>();
  EXPECT_EQ(TextOf(set->param_id), "WPNAV_SPEED");
  EXPECT_EQ(set->param_value, 800);
  EXPECT_EQ(autopilot_->parameter_writes().StateOf("WP_SPD"), ParameterWriteState::kWaiting);
  SendMessage(ValueOf("WPNAV_SPEED", 800, mavlink::kParamReal32));
  EXPECT_EQ(autopilot_->parameter_writes().StateOf("WP_SPD"), ParameterWriteState::kWritten);
  EXPECT_EQ(autopilot_->parameters().Find("WP_SPD"), 8);
}

TEST_F(AutopilotTest, ReportsUnwrittenParameters) {
  kind_ = mavlink::kAutopilotPx4;
  Start();
  Pass(1);
  const auto px4_value = [](std::int32_t value) {
    return ValueOf("COM_OBL_RC_ACT", std::bit_cast<float>(value), mavlink::kParamInt32);
  };
  autopilot_->SetParameter("COM_OBL_RC_ACT", 4);
  autopilot_->SetParameter("NO_SUCH", 1);
  SendMessage(px4_value(0));
  Pass(0.1);
  const auto set = last_heard_[mavlink::ParamSet::kId].As<mavlink::ParamSet>();
  EXPECT_EQ(set->param_value, std::bit_cast<float>(std::int32_t{4}));
  EXPECT_EQ(set->param_type, mavlink::kParamInt32);
  for (int i = 0; i < 8; ++i) {
    Pass(1);
    SendMessage(px4_value(0));
  }
  EXPECT_EQ(autopilot_->parameter_writes().StateOf("COM_OBL_RC_ACT"),
            ParameterWriteState::kRefused);
  EXPECT_EQ(autopilot_->parameter_writes().StateOf("NO_SUCH"), ParameterWriteState::kUnanswered);
  EXPECT_TRUE(autopilot_->parameter_writes().is_done());
}

TEST_F(AutopilotTest, RequestsModeUntilAnswered) {
  for (const bool is_px4 : {false, true}) {
    kind_ = is_px4 ? mavlink::kAutopilotPx4 : mavlink::kAutopilotArduPilot;
    mode_ = is_px4 ? 393216 : 4;
    events_.clear();
    Start();
    EXPECT_FALSE(autopilot_->RequestMode(FlightMode::kLand)) << "of whom?";
    Pass(1);
    EXPECT_TRUE(autopilot_->is_guided_mode());
    EXPECT_TRUE(autopilot_->RequestMode(FlightMode::kLand));
    Pass(0.5);
    const auto command = last_heard_[mavlink::CommandLong::kId].As<mavlink::CommandLong>();
    EXPECT_EQ(command->command, is_px4 ? mavlink::kCommandLand : mavlink::kCommandDoSetMode);
    EXPECT_EQ(command->param2, is_px4 ? 0 : 9);
    EXPECT_EQ(command->confirmation, 1);
    SendMessage(mavlink::CommandAck{command->command, mavlink::kResultDenied});
    EXPECT_FALSE(autopilot_->is_request_pending());
    EXPECT_EQ(TextOfEvent(AutopilotEventKind::kCommandRefused),
              "the autopilot refuses mode LAND: denied");
    autopilot_->DisarmByForce();
    Pass(3);
    EXPECT_EQ(TextOfEvent(AutopilotEventKind::kCommandUnanswered),
              "the autopilot does not answer the request for disarming");
  }
}

// PX4 numbers a mode by two numbers.
TEST_F(AutopilotTest, RequestsModeOfPx4ByTwoNumbers) {
  kind_ = mavlink::kAutopilotPx4;
  Start();
  Pass(1);
  autopilot_->RequestMode(FlightMode::kLand);
  autopilot_->RequestMode(FlightMode::kHold);  // in place of the landing
  Pass(0.5);
  const auto command = last_heard_[mavlink::CommandLong::kId].As<mavlink::CommandLong>();
  EXPECT_EQ(command->command, mavlink::kCommandDoSetMode);
  EXPECT_EQ(command->param2, 4);
  EXPECT_EQ(command->param3, 3);
}

// Otherwise a pilot who takes over would lose the mode again.
TEST_F(AutopilotTest, StopsRequestingModeWhenPilotChoosesAnother) {
  Start();
  Pass(1);
  autopilot_->RequestMode(FlightMode::kLand);
  Pass(0.1);
  mode_ = 5;
  SendHeartbeat(kind_, mode_);
  EXPECT_FALSE(autopilot_->is_request_pending());
  autopilot_->RequestMode(FlightMode::kLand);
  mode_ = 9;
  SendHeartbeat(kind_, mode_);
  EXPECT_TRUE(autopilot_->is_request_pending());
}

TEST_F(AutopilotTest, RequestsMissingStreamsLessOften) {
  Start();
  const auto requested = [&](double seconds) {
    intervals_us_.clear();
    int times = 0;
    for (int i = 0; i < std::lround(seconds); ++i) {
      Pass(1);
      times += static_cast<int>(intervals_us_.erase(mavlink::DistanceSensor::kId));
    }
    return times;
  };
  EXPECT_GT(requested(8), 3);
  EXPECT_LE(requested(60), 1);
}

}  // namespace
}  // namespace kestrel
