// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/gimbal_manager.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"

namespace kestrel {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// ArduPilot's parameter with the function of a channel of the transmitter, from 0.
std::string OptionName(std::size_t channel) { return fmt::format("RC{}_OPTION", channel + 1); }

}  // namespace

void GimbalManager::TakeControl() {
  control_ = Control::kRequested;
  status_.reset();
  is_reported_own_ = false;
  sticks_.reset();
  request_due_ = {};
}

void GimbalManager::Yield(const std::string& who) {
  control_ = Control::kTaken;
  taken_by_ = who;
}

void GimbalManager::Handle(const mavlink::Packet& packet) {
  if (packet.system != autopilot_.system() || packet.component != autopilot_.component()) return;
  if (const auto status = packet.As<mavlink::GimbalManagerStatus>()) {
    HandleStatus(*status);
  } else if (const auto information = packet.As<mavlink::GimbalManagerInformation>()) {
    HandleInformation(*information);
  } else if (const auto channels = packet.As<mavlink::RcChannels>()) {
    HandleChannels(*channels);
  } else if (const auto ack = packet.As<mavlink::CommandAck>()) {
    const bool is_given =
        ack->command == mavlink::kCommandGimbalConfigure && ack->result == mavlink::kResultAccepted;
    // An old manager reports no status.
    if (is_given && control_ == Control::kRequested && !status_) control_ = Control::kOwn;
  }
}

void GimbalManager::HandleStatus(const mavlink::GimbalManagerStatus& status) {
  if (device_id_ != 0 && status.gimbal_device_id != device_id_) return;
  status_ = status;
  const bool was_own = is_reported_own_;
  is_reported_own_ = status.primary_control_sysid == connection_.system() &&
                     status.primary_control_compid == connection_.component();
  if (control_ == Control::kRequested && is_reported_own_) control_ = Control::kOwn;
  if (control_ == Control::kTaken && is_reported_own_ && !was_own) control_ = Control::kOwn;
  if (control_ != Control::kOwn || is_reported_own_ || !was_own) return;
  const bool is_stick = status.primary_control_sysid == autopilot_.system() &&
                        status.primary_control_compid == autopilot_.component();
  Yield(is_stick ? "the pilot's stick"
                 : fmt::format("system {} component {}", status.primary_control_sysid,
                               status.primary_control_compid));
}

void GimbalManager::HandleInformation(const mavlink::GimbalManagerInformation& information) {
  if (device_id_ != 0 && information.gimbal_device_id != device_id_) return;
  const double side = std::min(-information.yaw_min, information.yaw_max);
  const bool is_valid = information.pitch_min < information.pitch_max && side > 0;
  if (!is_valid) return;
  range_ = GimbalRange{-information.pitch_max, -information.pitch_min, std::min(side, kPi)};
}

// ArduPilot gives the gimbal to a stick that moves and back to whoever sends the next set-point,
// and reports neither.
void GimbalManager::HandleChannels(const mavlink::RcChannels& message) {
  constexpr int kMoved_us = 30;
  if (control_ != Control::kOwn) return;
  Channels channels{};
  std::size_t count = 0;
  mavlink::RcChannels::Visit(message, [&](std::string_view, const auto& value, std::string_view) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::uint16_t>) {
      channels[count++] = value;
    }
  });
  if (!sticks_) sticks_ = channels;
  for (std::size_t i = 0; i < count; ++i) {
    if (std::abs((*sticks_)[i] - channels[i]) > kMoved_us && IsStick(i)) {
      return Yield("the pilot's stick");
    }
  }
}

bool GimbalManager::IsStick(std::size_t channel) const {
  // Roll, pitch and yaw of the first mount, and of the second.
  constexpr double kFirst = 212, kSecond = 215, kAxes = 3;
  constexpr int kSecondDevice = 2;
  const double first = device_id_ == kSecondDevice ? kSecond : kFirst;
  const double option = autopilot_.parameters().Find(OptionName(channel)).value_or(0);
  return option >= first && option < first + kAxes;
}

void GimbalManager::WantStickOptions() {
  constexpr std::size_t kWithOption = 16;
  if (wants_options_ || autopilot_.kind() != AutopilotKind::kArduPilot) return;
  wants_options_ = true;
  for (std::size_t i = 0; i < kWithOption; ++i) autopilot_.parameters().Want(OptionName(i));
}

void GimbalManager::Tick(Time now) {
  constexpr Duration kPeriod = std::chrono::milliseconds(500);
  constexpr int kMostRequests = 20;
  if (now < request_due_ || !autopilot_.is_here()) return;
  request_due_ = now + kPeriod;
  if (!range_ && information_requests_ < kMostRequests) {
    ++information_requests_;
    SendCommand(mavlink::kCommandRequestMessage,
                {static_cast<float>(mavlink::GimbalManagerInformation::kId), 0, 0, 0}, 0);
  }
  if (control_ != Control::kRequested) return;
  WantStickOptions();
  constexpr float kUnchanged = -1;
  SendCommand(mavlink::kCommandGimbalConfigure,
              {static_cast<float>(connection_.system()),
               static_cast<float>(connection_.component()), kUnchanged, kUnchanged},
              static_cast<float>(device_id_));
}

void GimbalManager::SendCommand(std::uint16_t command, const std::array<float, 4>& parameters,
                                float last) {
  mavlink::CommandLong message;
  message.target_system = autopilot_.system();
  message.target_component = autopilot_.component();
  message.command = command;
  message.param1 = parameters[0];
  message.param2 = parameters[1];
  message.param3 = parameters[2];
  message.param4 = parameters[3];
  message.param7 = last;
  connection_.Send(message);
}

// ArduPilot drops set-points that have rates, too. Without YAW_IN_EARTH_FRAME, which PX4 loses,
// YAW_LOCK means a yaw from north.
void GimbalManager::Send(const GimbalAngles& attitude) {
  if (control_ != Control::kOwn) return;
  mavlink::GimbalManagerSetPitchyaw message;
  message.target_system = autopilot_.system();
  message.target_component = autopilot_.component();
  message.flags = mavlink::kGimbalRollLock | mavlink::kGimbalPitchLock | mavlink::kGimbalYawLock;
  message.gimbal_device_id = static_cast<std::uint8_t>(device_id_);
  message.pitch = static_cast<float>(-attitude.pitch);
  message.yaw = static_cast<float>(std::remainder(kPi / 2 - attitude.yaw, 2 * kPi));
  message.pitch_rate = message.yaw_rate = kNan;
  connection_.Send(message);
}

}  // namespace kestrel
