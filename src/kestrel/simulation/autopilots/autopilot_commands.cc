// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/simulation/autopilots/autopilot_model.h"

// Messages that the simulated autopilot receives.
namespace kestrel {
namespace {

constexpr std::uint32_t kPx4TakeOff = Px4CustomMode(4, 2);
// Numbers of ArduCopter's modes that can be requested.
constexpr std::array<std::uint32_t, 13> kArduPilotModes = {0, 2,  3,  4,  5,  6, 7,
                                                           9, 16, 17, 20, 21, 23};
constexpr std::uint32_t kPx4LastMain = 8;
constexpr std::uint32_t kPx4LastSub = 9;

}  // namespace

void AutopilotModel::Handle(const CompanionMessage& message, std::uint8_t system,
                            std::uint8_t component, Time now) {
  if (IsSilentAfterReboot(now)) return;
  // Messages that claim to be from the autopilot itself are dropped.
  if (system == options_.system_id && component == mavlink::kComponentAutopilot) return;
  peer_system_ = system;
  peer_component_ = component;
  std::visit([&](const auto& typed) { Receive(typed, now); }, message);
}

void AutopilotModel::Receive(const mavlink::Heartbeat& message, Time /*now*/) {
  has_gcs_ = has_gcs_ || message.type == mavlink::kTypeGcs;
}

void AutopilotModel::Receive(const mavlink::Timesync& message, Time now) {
  if (message.tc1 == 0) {
    send_(mavlink::Timesync{.tc1 = OwnTime(now),
                            .ts1 = message.ts1,
                            .target_system = peer_system_,
                            .target_component = peer_component_});
  } else {
    px4_clock_.AddAnswer(message.ts1 / 1000, message.tc1 / 1000, OwnMicroseconds(now));
  }
}

void AutopilotModel::Receive(const mavlink::LandingTarget& message, Time /*now*/) {
  landing_->Handle(message, state_);
}

void AutopilotModel::Receive(const mavlink::TargetRelative& message, Time /*now*/) {
  landing_->Handle(message, state_);
}

void AutopilotModel::Receive(const mavlink::SetAttitudeTarget& message, Time now) {
  ReceiveSetPoint(message, now);
}

void AutopilotModel::Receive(const mavlink::SetPositionTargetLocalNed& message, Time now) {
  ReceiveSetPoint(message, now);
}

template <class Message>
void AutopilotModel::ReceiveSetPoint(const Message& message, Time now) {
  if (!IsForIt(message.target_system)) return;
  const bool is_guided = IsGuided();
  if (is_guided) {
    ++result_.set_points;
    is_taking_off_ = false;
  } else if (result_.left) {
    ++result_.set_points_after_take_back;
    result_.last_set_point_after_s = ToSeconds(now - *result_.left);
  }
  FlightState state = state_;
  state.time = now;
  Guided().Handle(message, state, is_guided);
}

bool AutopilotModel::IsForIt(std::uint8_t target_system) const {
  return target_system == 0 || target_system == options_.system_id;
}

void AutopilotModel::Receive(const mavlink::ParamRequestRead& message, Time /*now*/) {
  if (message.target_system != options_.system_id) return;
  const auto index = message.param_index < 0 ? parameters_.Find(TextOf(message.param_id))
                                             : std::optional<std::size_t>(message.param_index);
  if (index && *index < parameters_.size()) send_(ParamValueOf(parameters_, *index, firmware_));
}

void AutopilotModel::Receive(const mavlink::ParamRequestList& message, Time /*now*/) {
  if (message.target_system != options_.system_id) return;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    send_(ParamValueOf(parameters_, i, firmware_));
  }
}

void AutopilotModel::Receive(const mavlink::ParamSet& message, Time /*now*/) {
  if (message.target_system != options_.system_id) return;
  const auto index = parameters_.Find(TextOf(message.param_id));
  const double value = ValueOf(message, firmware_);
  if (!index || !std::isfinite(value)) return;
  parameters_.Set(*index, value);
  send_(ParamValueOf(parameters_, *index, firmware_));
}

void AutopilotModel::Receive(const mavlink::GimbalManagerSetPitchyaw& message, Time now) {
  if (mount_ && IsForIt(message.target_system)) {
    mount_->Handle(message, {peer_system_, peer_component_}, now);
  }
}

void AutopilotModel::Receive(const mavlink::SetGpsGlobalOrigin& message, Time /*now*/) {
  constexpr double kDegrees = 1e-7;
  if (!IsForIt(message.target_system) || has_origin_) return;
  options_.origin.latitude_deg = kDegrees * message.latitude;
  options_.origin.longitude_deg = kDegrees * message.longitude;
  has_origin_ = true;
}

void AutopilotModel::Receive(const mavlink::Odometry& message, Time /*now*/) {
  if (external_) external_->Handle(message);
}

void AutopilotModel::Receive(const mavlink::SetMode& message, Time now) {
  if (message.target_system != options_.system_id) return;
  if ((message.base_mode & mavlink::kModeFlagCustom) != 0) {
    EnterMode(message.custom_mode, Wish::kLink, now);
  }
}

void AutopilotModel::Receive(const mavlink::CommandLong& message, Time now) {
  if (!IsForIt(message.target_system)) return;
  send_(mavlink::CommandAck{.command = message.command,
                            .result = Execute(message, now),
                            .target_system = peer_system_,
                            .target_component = peer_component_});
}

std::uint8_t AutopilotModel::Execute(const mavlink::CommandLong& command, Time now) {
  const bool has_id = command.param1 >= 0 && command.param1 < (1 << 24);
  const auto id = static_cast<std::uint32_t>(has_id ? command.param1 : 0);
  switch (command.command) {
    case mavlink::kCommandSetMessageInterval:
      return has_id ? streams_.SetInterval(id, command.param2) : mavlink::kResultDenied;
    case mavlink::kCommandRequestMessage:
      return has_id && SendMessage(id, now) ? mavlink::kResultAccepted
                                            : mavlink::kResultUnsupported;
    case mavlink::kCommandDoSetMode:
      return SetModeBy(command, now);
    case mavlink::kCommandLand:
      if (!is_px4()) return mavlink::kResultUnsupported;
      EnterMode(FlightMode::kLand, Wish::kLink, now);
      return mavlink::kResultAccepted;
    case mavlink::kCommandArmDisarm:
      return Arm(command.param1 == 1, command.param2 == mavlink::kArmByForce);
    case mavlink::kCommandTakeOff:
      return TakeOff(command.param7, now);
    case mavlink::kCommandGripper:
      return OperateGripper(command.param2);
    case mavlink::kCommandGimbalConfigure:
    case mavlink::kCommandGimbalPitchyaw:
      return mount_ ? mount_->Execute(command, {peer_system_, peer_component_}, now)
                    : mavlink::kResultUnsupported;
    default:
      return mavlink::kResultUnsupported;
  }
}

std::uint8_t AutopilotModel::SetModeBy(const mavlink::CommandLong& command, Time now) {
  const auto is_index = [](float value, std::uint32_t last) {
    return value >= 0 && value <= static_cast<float>(last) && value == std::floor(value);
  };
  if (command.param1 != mavlink::kModeFlagCustom) return mavlink::kResultDenied;
  if (is_px4()) {
    if (!is_index(command.param2, kPx4LastMain) || !is_index(command.param3, kPx4LastSub)) {
      return mavlink::kResultDenied;
    }
    const std::uint32_t mode = Px4CustomMode(static_cast<std::uint32_t>(command.param2),
                                             static_cast<std::uint32_t>(command.param3));
    // Only NAV_LAND is taken without a position.
    const bool is_land = mode == CustomModeOf(kind(), FlightMode::kLand);
    if (is_land && LacksPosition()) return mavlink::kResultTemporarilyRejected;
    return EnterMode(mode, Wish::kLink, now) ? mavlink::kResultAccepted
                                             : mavlink::kResultTemporarilyRejected;
  }
  const auto mode = std::ranges::find_if(kArduPilotModes, [&](std::uint32_t known) {
    return static_cast<float>(known) == command.param2;
  });
  if (mode == kArduPilotModes.end()) return mavlink::kResultFailed;
  return EnterMode(*mode, Wish::kLink, now) ? mavlink::kResultAccepted : mavlink::kResultFailed;
}

std::uint8_t AutopilotModel::Arm(bool arm, bool by_force) {
  if (arm == is_armed_) return mavlink::kResultAccepted;
  // A plain disarm is accepted only after landing.
  if (!arm && !by_force && !detector_.has_landed()) return mavlink::kResultFailed;
  is_armed_ = arm;
  resumes_guided_ = false;
  if (arm) {
    hold_ = state_.position();
    landing_since_.reset();
  } else {
    result_.was_forced = by_force;
    SendText(Severity::kInfo, "Disarming motors");
  }
  return mavlink::kResultAccepted;
}

std::uint8_t AutopilotModel::OperateGripper(float motion) {
  if (!options_.has_gripper) return mavlink::kResultUnsupported;
  const Eigen::Vector3d feet = truth().world_from_body * Eigen::Vector3d(0, 0, -options_.uav.leg_m);
  if (motion == mavlink::kGripperRelease) {
    result_.released_at = feet;
    if (std::exchange(result_.holds_object, false)) result_.put_down.push_back(feet);
    return mavlink::kResultAccepted;
  }
  if (motion != mavlink::kGripperGrab) return mavlink::kResultDenied;
  ++result_.grabs;
  if (result_.holds_object) return mavlink::kResultAccepted;
  result_.grab = world_.field().Close(world_.SceneTime(truth().time), feet);
  result_.holds_object = result_.grab && result_.grab->is_taken;
  return mavlink::kResultAccepted;
}

// 'altitude': above home for ArduPilot, above sea level for PX4.
std::uint8_t AutopilotModel::TakeOff(double altitude, Time now) {
  constexpr double kPx4Default_m = 2.5;
  if (!is_armed_) return mavlink::kResultFailed;
  if (is_px4()) {
    EnterMode(kPx4TakeOff, Wish::kLink, now);
    hold_.z() = std::isfinite(altitude) ? altitude - options_.origin.altitude_m
                                        : state_.position().z() + kPx4Default_m;
    return mavlink::kResultAccepted;
  }
  if (!IsIn(FlightMode::kGuided) || !std::isfinite(altitude) || altitude <= 0) {
    return mavlink::kResultFailed;
  }
  pilot_flies_ = false;
  is_taking_off_ = true;
  hold_.z() = altitude;
  return mavlink::kResultAccepted;
}

}  // namespace kestrel
