// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/sitl/autopilot_model.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/base/options.h"
#include "kestrel/base/parse_number.h"
#include "kestrel/base/violations.h"
#include "kestrel/geometry/angles.h"
#include "kestrel/link/mavlink_enums.h"
#include "kestrel/sitl/ardupilot_landing.h"
#include "kestrel/sitl/px4_landing.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr Duration kModelStep = std::chrono::milliseconds(4);
constexpr Duration kBootTime = std::chrono::seconds(3);  // silent after a reboot
constexpr float kForce = 21196;                          // param2 of an arming command
constexpr std::uint16_t kCommandTakeOff = 22;

// custom_mode of ArduCopter and of PX4 (main << 16 | sub << 24).
constexpr std::uint32_t kArduPilotGuided = 4;
constexpr std::uint32_t kArduPilotLoiter = 5;
constexpr std::uint32_t kArduPilotLand = 9;
constexpr std::uint32_t Px4Mode(std::uint32_t main, std::uint32_t sub) {
  return main << 16 | sub << 24;
}
constexpr std::uint32_t kPx4TakeOff = Px4Mode(4, 2);
constexpr std::uint32_t kPx4Loiter = Px4Mode(4, 3);
constexpr std::uint32_t kPx4Land = Px4Mode(4, 6);
constexpr std::uint32_t kPx4PrecisionLand = Px4Mode(4, 9);
constexpr std::array<std::uint32_t, 12> kArduPilotModes = {
    0, 2, 3, kArduPilotGuided, kArduPilotLoiter, 6, 7, kArduPilotLand, 16, 17, 21, 23};
constexpr std::uint32_t kPx4LastMain = 8;
constexpr std::uint32_t kPx4LastSub = 9;

// "NAME=value,NAME=value"
void SetParameters(const std::string& list, AutopilotParameters* parameters) {
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string setting = list.substr(begin, end - begin);
    const std::size_t equals = setting.find('=');
    const auto index = parameters->Find(setting.substr(0, equals));
    const auto value = equals == std::string::npos
                           ? std::nullopt
                           : ParseNumber<double>(setting.substr(equals + 1));
    if (!index || !value) {
      throw InputError(fmt::format(
          "parameters has '{}', expected NAME=value of a parameter of this autopilot", setting));
    }
    parameters->Set(*index, *value);
    begin = end + 1;
  }
}

AutopilotParameters ParametersOf(AutopilotFirmware firmware, const std::string& list) {
  AutopilotParameters parameters(firmware);
  SetParameters(list, &parameters);
  return parameters;
}

Vector3d PilotPlace(const PilotOptions& pilot, const VehicleWorld& world, Time now) {
  return world.PatternAt(now).translation +
         Vector3d(pilot.offset_east_m, pilot.offset_north_m, pilot.start_altitude_m);
}

SimulatedUav MakeUav(const AutopilotModelOptions& options, const VehicleWorld& world, Time start,
                     Random* random) {
  const PilotOptions& pilot = options.pilot;
  const double heading = Radians(90 - pilot.heading_deg);
  if (pilot.start_altitude_m <= 0) {
    return {options.uav, world, start, Vector3d::Zero(), Vector3d::Zero(), heading, random};
  }
  const Vector3d velocity =
      pilot.follows_vehicle ? world.VelocityAt(start) : Vector3d(Vector3d::Zero());
  return {options.uav, world, start, PilotPlace(pilot, world, start), velocity, heading, random};
}

}  // namespace

std::vector<std::string> PilotOptions::Validate() const {
  std::vector<std::string> violations;
  RequireIn(start_altitude_m, 0, 200, "start_altitude_m", &violations);
  RequireIn(offset_east_m, -100, 100, "offset_east_m", &violations);
  RequireIn(offset_north_m, -100, 100, "offset_north_m", &violations);
  RequireIn(heading_deg, -360, 360, "heading_deg", &violations);
  RequireIn(land_after_s, -1, 10000, "land_after_s", &violations);
  return violations;
}

// A good estimate: its errors are not what is tested.
AutopilotModelOptions::AutopilotModelOptions() {
  navigation.position_noise_m = 0.003;
  navigation.position_drift_m = 0.005;
  navigation.position_bias_m = 0;
  navigation.attitude_noise_deg = 0.05;
  navigation.attitude_bias_deg = 0.05;
  navigation.mount_error_deg = 0;
  navigation.clock_offset_min_s = 0;
  navigation.clock_offset_max_s = 0;
}

std::vector<std::string> AutopilotModelOptions::Validate() const {
  std::vector<std::string> violations;
  RequireIn(system_id, 1, 255, "system_id", &violations);
  RequireIn(uptime_s, 0, 1e6, "uptime_s", &violations);
  RequireIn(drift_ppm, -1000, 1000, "drift_ppm", &violations);
  RequireIn(origin.latitude_deg, -80, 80, "origin.latitude_deg", &violations);
  RequireIn(origin.longitude_deg, -180, 180, "origin.longitude_deg", &violations);
  RequireIn(origin.altitude_m, -500, 9000, "origin.altitude_m", &violations);
  AddViolations("uav", uav.Validate(), &violations);
  AddViolations("navigation", navigation.Validate(), &violations);
  AddViolations("pilot", pilot.Validate(), &violations);
  return violations;
}

AutopilotModel::AutopilotModel(AutopilotFirmware firmware, const AutopilotModelOptions& options,
                               VehicleWorld* world, Time start, std::uint64_t seed, Send send)
    : firmware_(firmware),
      options_(Checked(options)),
      world_(*world),
      send_(std::move(send)),
      random_(seed),
      parameters_(ParametersOf(firmware, options.parameters)),
      uav_(MakeUav(options, *world, start, &random_)),
      navigation_(options.navigation, NavigationErrors(), Random(random_.Bits())),
      streams_(firmware),
      start_(start),
      stepped_to_(start),
      booted_at_(start),
      boot_uptime_s_(options.uptime_s) {
  const Announce announce = [this](Severity severity, const std::string& text) {
    Say(severity, text);
  };
  if (firmware == AutopilotFirmware::kPx4) {
    rules_ = std::make_unique<Px4Landing>(parameters_, px4_clock_, announce);
    custom_mode_ = kPx4Loiter;
  } else {
    rules_ = std::make_unique<ArduPilotLanding>(parameters_, announce);
    custom_mode_ = kArduPilotLoiter;
  }
  pilot_flies_ = options.pilot.start_altitude_m > 0;
  is_armed_ = pilot_flies_;
  ObserveFlight(start);
  hold_ = state_.position();
}

std::int64_t AutopilotModel::OwnTime(Time now) const {
  const double rate = 1 + 1e-6 * options_.drift_ppm;
  const auto since_boot = static_cast<double>((now - booted_at_).count());
  return std::llround(1e9 * boot_uptime_s_) + std::llround(rate * since_boot) + clock_jump_.count();
}

void AutopilotModel::Step(Time now) {
  while (stepped_to_ + kModelStep <= now) {
    stepped_to_ += kModelStep;
    StepOnce(stepped_to_);
  }
}

void AutopilotModel::StepOnce(Time now) {
  uav_.Step(now, Fly(now), is_armed_);
  world_.ObserveUav(now, uav_.pose().world_from_body.translation);
  ObserveFlight(now);
  rules_->Estimate(state_);
  FollowScript(now);
  FinishLanding(now);
  if (now - booted_at_ < kBootTime && booted_at_ != start_) return;
  streams_.SendDue(OwnMicroseconds(now), [&](std::uint32_t id) { SendMessage(id, now); });
}

void AutopilotModel::ObserveFlight(Time now) {
  const PoseSample& truth = uav_.pose();
  state_.step_s = ToSeconds(now - state_.time);
  state_.time = now;
  state_.boot_us = OwnMicroseconds(now);
  state_.pose = navigation_.Report(world_.SceneTime(truth.time), truth.world_from_body);
  state_.pose.time = now;
  state_.pose.motion = truth.motion;
  state_.is_standing = uav_.is_standing();
}

void AutopilotModel::FollowScript(Time now) {
  const double land_after_s = options_.pilot.land_after_s;
  if (!pilot_flies_ || land_after_s < 0 || ToSeconds(now - start_) < land_after_s) return;
  EnterMode(firmware_ == AutopilotFirmware::kPx4 ? kPx4PrecisionLand : kArduPilotLand, now);
}

bool AutopilotModel::Lands() const {
  return firmware_ == AutopilotFirmware::kPx4 ? custom_mode_ == kPx4PrecisionLand
                                              : custom_mode_ == kArduPilotLand;
}

SetPoint AutopilotModel::Fly(Time now) {
  if (Lands()) return rules_->Land(state_);
  if (pilot_flies_ && options_.pilot.follows_vehicle) return FollowVehicle(now);
  return Hold();
}

SetPoint AutopilotModel::FollowVehicle(Time now) const {
  constexpr double kGain = 1;
  constexpr double kMax_mps = 5;
  const Vector3d way = PilotPlace(options_.pilot, world_, now) - state_.position();
  SetPoint command;
  command.velocity = world_.VelocityAt(now);
  command.velocity.head<2>() += BrakingVelocity(way.head<2>(), kGain, 2.5, kMax_mps);
  command.velocity.z() = std::clamp(kGain * way.z(), -1.5, 1.5);
  return command;
}

SetPoint AutopilotModel::Hold() const {
  constexpr double kMax_mps = 5;
  const Vector3d way = hold_ - state_.position();
  SetPoint command;
  command.velocity.head<2>() = BrakingVelocity(way.head<2>(), 1, 2.5, kMax_mps);
  command.velocity.z() = std::clamp(way.z(), -1.5, 2.5);
  // PX4's plain LAND goes straight down.
  if (custom_mode_ == kPx4Land && firmware_ == AutopilotFirmware::kPx4) {
    command.velocity.z() = -parameters_["MPC_LAND_SPEED"];
  }
  return command;
}

void AutopilotModel::EnterMode(std::uint32_t custom_mode, Time now) {
  pilot_flies_ = false;
  if (custom_mode == custom_mode_) return;
  custom_mode_ = custom_mode;
  hold_ = state_.position();
  if (!Lands()) return;
  landing_since_ = now;
  result_ = {};
  rules_->StartLanding(state_);
}

void AutopilotModel::FinishLanding(Time now) {
  if (!Lands() || !landing_since_ || !is_armed_) return;
  if (!result_.contact && uav_.is_standing() && uav_.contact() &&
      uav_.contact()->time >= *landing_since_) {
    result_.contact = uav_.contact();
    result_.landing_s = ToSeconds(now - *landing_since_);
  }
  if (!rules_->disarms()) return;
  is_armed_ = false;
  result_.is_disarmed = true;
  if (result_.contact) result_.disarm_s = ToSeconds(now - result_.contact->time);
  Say(Severity::kInfo,
      firmware_ == AutopilotFirmware::kPx4 ? "Disarmed by landing" : "Disarming motors");
}

void AutopilotModel::Reboot(Time now) {
  booted_at_ = now;
  boot_uptime_s_ = 0;
  clock_jump_ = Duration(0);
  streams_ = MessageStreams(firmware_);
  px4_clock_ = Px4TimeSync();
  has_gcs_ = false;
}

void AutopilotModel::JumpClock(Duration change) { clock_jump_ += change; }

// PX4 tells texts only where a ground station listens; to others it sends events, which nobody here
// needs.
void AutopilotModel::Say(Severity severity, const std::string& text) const {
  if (firmware_ == AutopilotFirmware::kPx4 && !has_gcs_) return;
  mavlink::Statustext message;
  message.severity = static_cast<std::uint8_t>(severity);
  message.text = CharsOf<50>(text);
  send_(message);
}

std::uint8_t AutopilotModel::LandedState() const {
  if (!is_armed_ || rules_->has_landed()) return mavlink::kLandedOnGround;
  return Lands() ? mavlink::kLandedLanding : mavlink::kLandedInAir;
}

mavlink::Heartbeat AutopilotModel::HeartbeatOf() const {
  constexpr std::uint8_t kVersion = 3;
  mavlink::Heartbeat message;
  message.type = mavlink::kTypeQuadrotor;
  message.autopilot =
      firmware_ == AutopilotFirmware::kPx4 ? mavlink::kAutopilotPx4 : mavlink::kAutopilotArduPilot;
  message.base_mode = mavlink::kModeFlagCustom;
  if (is_armed_) message.base_mode |= mavlink::kModeFlagArmed;
  message.custom_mode = custom_mode_;
  message.system_status = is_armed_ ? mavlink::kStateActive : mavlink::kStateStandby;
  message.mavlink_version = kVersion;
  return message;
}

mavlink::AutopilotVersion AutopilotModel::VersionOf() const {
  // Major, minor, patch, type (255: a release; 0: in development).
  constexpr std::uint32_t kArduPilot47 = 4u << 24 | 7u << 16;
  constexpr std::uint32_t kPx4118 = 1u << 24 | 18u << 16;
  mavlink::AutopilotVersion message;
  message.flight_sw_version = firmware_ == AutopilotFirmware::kPx4 ? kPx4118 : kArduPilot47;
  constexpr std::uint64_t kSpeaksMavlink2 = 8192;
  message.capabilities = kSpeaksMavlink2;
  message.uid = static_cast<std::uint64_t>(options_.system_id);
  return message;
}

bool AutopilotModel::SendMessage(std::uint32_t id, Time now) {
  const PoseSample& pose = state_.pose;
  const std::int64_t own_us = state_.boot_us;
  const auto own_ms = static_cast<std::uint32_t>(own_us / 1000);
  switch (id) {
    case mavlink::Heartbeat::kId:
      send_(HeartbeatOf());
      return true;
    case mavlink::Attitude::kId: {
      mavlink::Attitude message = AttitudeOf(pose, own_ms);
      if (nan_attitude_) message.roll = std::numeric_limits<float>::quiet_NaN();
      send_(message);
      return true;
    }
    case mavlink::AttitudeQuaternion::kId: {
      mavlink::AttitudeQuaternion message = AttitudeQuaternionOf(pose, own_ms);
      if (nan_attitude_) message.q1 = std::numeric_limits<float>::quiet_NaN();
      send_(message);
      return true;
    }
    case mavlink::LocalPositionNed::kId:
      send_(LocalPositionOf(pose, own_ms));
      return true;
    case mavlink::GlobalPositionInt::kId:
      send_(GlobalPositionOf(pose, options_.origin, own_ms));
      return true;
    case mavlink::GpsGlobalOrigin::kId:
      send_(GlobalOriginOf(options_.origin, own_us));
      return true;
    case mavlink::HomePosition::kId:
      send_(HomePositionOf(options_.origin, own_us));
      return true;
    case mavlink::SimState::kId:
      send_(SimStateOf(uav_.pose(), options_.origin));
      return true;
    case mavlink::ExtendedSysState::kId:
      send_(mavlink::ExtendedSysState{.vtol_state = 0, .landed_state = LandedState()});
      return true;
    case mavlink::Timesync::kId:
      send_(mavlink::Timesync{.tc1 = 0, .ts1 = OwnTime(now)});
      return true;
    case mavlink::AutopilotVersion::kId:
      send_(VersionOf());
      return true;
    default:
      return false;
  }
}

void AutopilotModel::Handle(const CompanionMessage& message, std::uint8_t system,
                            std::uint8_t component, Time now) {
  if (now - booted_at_ < kBootTime && booted_at_ != start_) return;
  // What claims to be the autopilot itself is dropped.
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
  rules_->Handle(message, state_);
}

void AutopilotModel::Receive(const mavlink::TargetRelative& message, Time /*now*/) {
  rules_->Handle(message, state_);
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

void AutopilotModel::Receive(const mavlink::SetMode& message, Time now) {
  if (message.target_system != options_.system_id) return;
  if ((message.base_mode & mavlink::kModeFlagCustom) != 0) EnterMode(message.custom_mode, now);
}

void AutopilotModel::Receive(const mavlink::CommandLong& message, Time now) {
  if (message.target_system != 0 && message.target_system != options_.system_id) return;
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
    case mavlink::kCommandArmDisarm:
      return Arm(command.param1 == 1, command.param2 == kForce);
    case kCommandTakeOff:
      return TakeOff(command.param7, now);
    default:
      return mavlink::kResultUnsupported;
  }
}

std::uint8_t AutopilotModel::SetModeBy(const mavlink::CommandLong& command, Time now) {
  const auto is_index = [](float value, std::uint32_t last) {
    return value >= 0 && value <= static_cast<float>(last) && value == std::floor(value);
  };
  if (command.param1 != mavlink::kModeFlagCustom) return mavlink::kResultDenied;
  if (firmware_ == AutopilotFirmware::kPx4) {
    if (!is_index(command.param2, kPx4LastMain) || !is_index(command.param3, kPx4LastSub)) {
      return mavlink::kResultDenied;
    }
    EnterMode(Px4Mode(static_cast<std::uint32_t>(command.param2),
                      static_cast<std::uint32_t>(command.param3)),
              now);
    return mavlink::kResultAccepted;
  }
  const auto mode = std::ranges::find_if(kArduPilotModes, [&](std::uint32_t known) {
    return static_cast<float>(known) == command.param2;
  });
  if (mode == kArduPilotModes.end()) return mavlink::kResultFailed;
  EnterMode(*mode, now);
  return mavlink::kResultAccepted;
}

std::uint8_t AutopilotModel::Arm(bool arm, bool by_force) {
  if (arm == is_armed_) return mavlink::kResultAccepted;
  // A plain disarm is for what has landed.
  const bool rests = uav_.is_standing() && (!landing_since_ || rules_->has_landed());
  if (!arm && !by_force && !rests) return mavlink::kResultFailed;
  is_armed_ = arm;
  if (arm) {
    hold_ = state_.position();
    landing_since_.reset();
  } else {
    Say(Severity::kInfo, "Disarming motors");
  }
  return mavlink::kResultAccepted;
}

// 'altitude': above home for ArduPilot, above the sea for PX4.
std::uint8_t AutopilotModel::TakeOff(double altitude, Time now) {
  constexpr double kPx4Default_m = 2.5;
  if (!is_armed_) return mavlink::kResultFailed;
  if (firmware_ == AutopilotFirmware::kPx4) {
    EnterMode(kPx4TakeOff, now);
    hold_.z() = std::isfinite(altitude) ? altitude - options_.origin.altitude_m
                                        : state_.position().z() + kPx4Default_m;
    return mavlink::kResultAccepted;
  }
  if (custom_mode_ != kArduPilotGuided || !std::isfinite(altitude) || altitude <= 0)
    return mavlink::kResultFailed;
  pilot_flies_ = false;
  hold_.z() = altitude;
  return mavlink::kResultAccepted;
}

std::string InWords(const SitlResult& result) {
  if (!result.contact) return "did not come down in a landing mode\n";
  const std::string where =
      result.contact->on_board
          ? fmt::format("on the board, {:.3f} m from the pattern's centre", result.offset_m())
          : fmt::format("beside the board, {:.2f} m from the pattern's centre", result.offset_m());
  const std::string disarmed =
      result.is_disarmed ? fmt::format("disarmed {:.1f} s later", result.disarm_s) : "not disarmed";
  return fmt::format("came down {}, {:.1f} s after the landing began; {}\n", where,
                     result.landing_s, disarmed);
}

}  // namespace kestrel
