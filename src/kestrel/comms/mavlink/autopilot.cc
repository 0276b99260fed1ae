// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/autopilot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/camera_messages.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/ned.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

// Rates that are requested beside those below.
constexpr double kLandedRate_hz = 5;
constexpr double kRangeRate_hz = 20;
constexpr double kGimbalRate_hz = 50;
constexpr double kZoomRate_hz = 10;
constexpr double kGimbalControl_hz = 5;
constexpr double kStatusRate_hz = 2;
constexpr double kAcceleration_hz = 50;
constexpr double kClimbRate_hz = 20;
constexpr double kGnssRate_hz = 5;  // where a flight goes on without it
constexpr double kTruePoseRate_hz = 100;
// After so long without a heartbeat the autopilot is away.
constexpr double kAwayAfter_s = 3;
// An older position does not show where the vehicle is now.
constexpr double kPositionAge_s = 0.5;

using std::chrono::seconds;

bool IsAutopilotHeartbeat(const mavlink::Heartbeat& heartbeat) {
  return heartbeat.autopilot != mavlink::kAutopilotInvalid && heartbeat.type != mavlink::kTypeGcs &&
         heartbeat.type != mavlink::kTypeOnboardController;
}

bool IsArmed(const mavlink::Heartbeat& heartbeat) {
  return (heartbeat.base_mode & mavlink::kModeFlagArmed) != 0;
}

std::optional<std::uint32_t> BootTimeIn(const mavlink::Packet& packet) {
  if (const auto message = packet.As<mavlink::AttitudeQuaternion>()) return message->time_boot_ms;
  if (const auto message = packet.As<mavlink::Attitude>()) return message->time_boot_ms;
  if (const auto message = packet.As<mavlink::LocalPositionNed>()) return message->time_boot_ms;
  if (const auto message = packet.As<mavlink::SystemTime>()) return message->time_boot_ms;
  return std::nullopt;
}

bool IsInFailsafe(const mavlink::Heartbeat& heartbeat) {
  return heartbeat.system_status == mavlink::kStateCritical ||
         heartbeat.system_status == mavlink::kStateEmergency;
}

}  // namespace

Autopilot::Autopilot(const AutopilotOptions& options, Connection* connection,
                     AutopilotListener listener)
    : options_(options),
      connection_(connection),
      listener_(std::move(listener)),
      poses_(kPositionAge_s) {
  RequireValid(options);
  if (options.gimbal_device_id) gimbal_.emplace(*options.gimbal_device_id);
  if (options.zoom_device_id) zoom_.emplace(*options.zoom_device_id);
}

bool Autopilot::is_armed() const { return IsArmed(heartbeat_); }

bool Autopilot::is_in_failsafe() const { return IsInFailsafe(heartbeat_); }

std::optional<bool> Autopilot::is_position_good(Time now) const {
  const auto& estimator = status_.estimator();
  if (!estimator || ToSeconds(now - estimator->received) > kAwayAfter_s) {
    return std::nullopt;
  }
  return estimator->is_good;
}

void Autopilot::Notify(AutopilotEventKind kind, std::string text) {
  if (listener_.event) listener_.event({kind, std::move(text)});
}

template <class Text>
void Autopilot::ReportOnce(AutopilotEventKind kind, const Text& make_text) {
  const std::uint32_t bit = 1u << static_cast<unsigned>(kind);
  if ((reported_ & bit) != 0) return;
  reported_ |= bit;
  Notify(kind, make_text());
}

void Autopilot::Handle(const mavlink::Packet& packet, Time received) {
  if (const auto heartbeat = packet.As<mavlink::Heartbeat>()) {
    HandleHeartbeat(packet, *heartbeat, received);
  }
  if (packet.system == connection_->system() && packet.component == connection_->component() &&
      !(packet.system == system_ && packet.component == component_)) {
    ++counters_.own_ids;
    ReportOnce(AutopilotEventKind::kIdClash, [&] {
      return fmt::format(
          "somebody else sends as system {} component {}, or the link sends our own messages back: "
          "they are ignored",
          packet.system, packet.component);
    });
    return;
  }
  if (packet.id == mavlink::LandingTarget::kId) {
    ++counters_.target_echoes;
    ReportOnce(AutopilotEventKind::kTargetEcho, [&] {
      return fmt::format("system {} component {} sends landing targets too: they are ignored",
                         packet.system, packet.component);
    });
    return;
  }
  HandleGimbal(packet, received);
  HandleZoom(packet, received);
  if (IsFromAutopilot(packet)) HandleFromAutopilot(packet, received);
}

// A gimbal is the autopilot's own, or another component of the vehicle.
void Autopilot::HandleGimbal(const mavlink::Packet& packet, Time received) {
  if (!gimbal_ || system_ == 0 || packet.system != system_) return;
  const auto sample = gimbal_->Handle(packet, received, component_, clock_.sync());
  if (!sample) return;
  if (packet.component != component_) streams_.Count(packet.id);
  if (listener_.gimbal) listener_.gimbal(*sample);
}

// A camera is behind the autopilot, or another component of the vehicle.
void Autopilot::HandleZoom(const mavlink::Packet& packet, Time received) {
  if (!zoom_ || system_ == 0 || packet.system != system_) return;
  const auto sample = zoom_->Handle(packet, received, component_, clock_.sync());
  if (!sample) return;
  if (packet.component != component_) streams_.Count(packet.id);
  if (listener_.zoom) listener_.zoom(*sample);
}

bool Autopilot::IsFromAutopilot(const mavlink::Packet& packet) {
  if (system_ == 0) return false;
  if (packet.system != system_) ++counters_.other_systems;
  return packet.system == system_ && packet.component == component_;
}

void Autopilot::HandleHeartbeat(const mavlink::Packet& packet, const mavlink::Heartbeat& heartbeat,
                                Time received) {
  if (!IsAutopilotHeartbeat(heartbeat) || packet.system == 0) return;
  if (options_.system_id != 0 && packet.system != options_.system_id) return;
  if (system_ == 0) Adopt(packet, heartbeat);
  if (packet.system != system_ || packet.component != component_) {
    ReportOnce(AutopilotEventKind::kOtherAutopilot, [&] {
      return fmt::format(
          "another autopilot, system {} component {}, is on the link: only system {} component {} "
          "is listened to",
          packet.system, packet.component, system_, component_);
    });
    return;
  }
  const mavlink::Heartbeat before = std::exchange(heartbeat_, heartbeat);
  heard_ = mode_reported_ = received;
  if (is_here_) return ReportChange(before);
  is_here_ = true;
  const bool is_first = kind_ == AutopilotKind::kUnknown;
  kind_ = AutopilotKindOf(heartbeat.autopilot);
  WantStreams();
  Notify(
      is_first ? AutopilotEventKind::kHeard : AutopilotEventKind::kBack,
      fmt::format("{} (system {}) {}, {}, {}", ToString(kind_), system_,
                  is_first ? "heard" : "is back", mode_name(), is_armed() ? "armed" : "disarmed"));
  if (is_in_failsafe()) {
    Notify(AutopilotEventKind::kFailsafe, FailsafeInWords(kind_, heartbeat_.custom_mode));
  }
}

void Autopilot::ReportChange(const mavlink::Heartbeat& before) {
  if (heartbeat_.custom_mode != before.custom_mode && heartbeat_.custom_mode != requested_mode_) {
    DropModeRequest();
  }
  if (heartbeat_.custom_mode != before.custom_mode || is_armed() != IsArmed(before)) {
    Notify(AutopilotEventKind::kModeChanged,
           fmt::format("mode {}, {}", mode_name(), is_armed() ? "armed" : "disarmed"));
  }
  if (is_in_failsafe() && !IsInFailsafe(before)) {
    Notify(AutopilotEventKind::kFailsafe, FailsafeInWords(kind_, heartbeat_.custom_mode));
  }
}

void Autopilot::Adopt(const mavlink::Packet& packet, const mavlink::Heartbeat& heartbeat) {
  system_ = packet.system;
  component_ = packet.component;
  heartbeat_ = heartbeat;
  if (connection_->takes_system_of_autopilot()) connection_->SetSystem(system_);
  if (connection_->system() == system_ && connection_->component() == component_) {
    ReportOnce(AutopilotEventKind::kOwnIdIsAutopilots, [&] {
      return fmt::format(
          "system {} component {} is the autopilot itself, which ignores whoever sends as it: "
          "expected another component_id, as 191",
          system_, component_);
    });
  }
}

void Autopilot::HandleFromAutopilot(const mavlink::Packet& packet, Time received) {
  received_ = received;
  CountLost(packet);
  streams_.Count(packet.id);
  WatchBoot(packet, received);
  if (const auto mode = packet.As<mavlink::CurrentMode>()) {
    const mavlink::Heartbeat before = heartbeat_;
    heartbeat_.custom_mode = mode->custom_mode;
    mode_reported_ = received;
    ReportChange(before);
  } else if (const auto timesync = packet.As<mavlink::Timesync>()) {
    HandleTimesync(*timesync, received);
  } else if (const auto ack = packet.As<mavlink::CommandAck>()) {
    HandleAck(*ack);
  } else if (const auto value = packet.As<mavlink::ParamValue>()) {
    parameters_.Handle(kind_, *value);
    writes_.Handle(kind_, *value, parameters_);
  } else if (const auto text = packet.As<mavlink::Statustext>()) {
    if (listener_.text) listener_.text(text->severity, TextOf(text->text));
  } else if (!HandlePose(packet, received) && !HandleTruePose(packet, received) &&
             !HandleAcceleration(packet) && !HandleClimb(packet)) {
    HandleStatus(packet, received);
  }
}

bool Autopilot::HandlePose(const mavlink::Packet& packet, Time received) {
  PoseSample pose;
  if (const auto quaternion = packet.As<mavlink::AttitudeQuaternion>()) {
    ReportPose(poses_.Handle(*quaternion, received, &clock_, &pose), "attitude", pose);
  } else if (const auto attitude = packet.As<mavlink::Attitude>()) {
    ReportPose(poses_.Handle(*attitude, received, &clock_, &pose), "attitude", pose);
  } else if (const auto position = packet.As<mavlink::LocalPositionNed>()) {
    const PoseFate fate = poses_.Handle(*position);
    // A position alone makes no pose.
    ReportPose(fate == PoseFate::kUsed ? PoseFate::kNone : fate, "position", pose);
  } else {
    return false;
  }
  return true;
}

void Autopilot::ReportPose(PoseFate fate, const char* what, const PoseSample& pose) {
  switch (fate) {
    case PoseFate::kUsed:
      newest_pose_ = pose.time;
      ReportAttitude(pose);
      if (listener_.pose) listener_.pose(pose);
      break;
    case PoseFate::kNone:
      return;
    case PoseFate::kNotFinite:
      return ReportNotFinite(what);
    case PoseFate::kBackwards:
      ++counters_.backwards;
      return ReportOnce(AutopilotEventKind::kTimeBackwards, [&] {
        return fmt::format(
            "a message of the autopilot is {:.3f} s older than the one before: ignored",
            poses_.back_s());
      });
    case PoseFate::kRestarted:
      ++counters_.backwards;
      return Restart();
    case PoseFate::kWithoutClock:
      ++counters_.without_clock;
      return;
    case PoseFate::kWithoutPosition:
      ++counters_.without_position;
      ReportAttitude(pose);
      break;
  }
  if (!clock_.is_one_way()) return;
  ReportOnce(AutopilotEventKind::kNoTimeSync, [] {
    return std::string(
        "the autopilot does not answer TIMESYNC: its clock is known by the delay of the line only");
  });
}

void Autopilot::ReportAttitude(PoseSample pose) {
  if (!listener_.attitude) return;
  pose.world_from_body.translation.setZero();
  pose.motion->velocity_in_world.setZero();
  listener_.attitude(pose);
}

bool Autopilot::HandleAcceleration(const mavlink::Packet& packet) {
  constexpr double kMilliG = 9.80665e-3;
  constexpr std::int64_t kNsPerUs = 1000;
  const auto raw = packet.As<mavlink::RawImu>();
  const auto highres = packet.As<mavlink::HighresImu>();
  if (!raw && !highres) return false;
  if (!listener_.acceleration || !clock_.sync().is_known()) return true;
  const Eigen::Vector3d in_frd =
      raw ? Eigen::Vector3d(kMilliG * Eigen::Vector3d(raw->xacc, raw->yacc, raw->zacc))
          : Eigen::Vector3d(highres->xacc, highres->yacc, highres->zacc);
  if (!in_frd.allFinite()) return true;
  const std::uint64_t stamp_us = raw ? raw->time_usec : highres->time_usec;
  constexpr std::uint64_t kMaxStamp_us = std::uint64_t{1} << 50;
  if (stamp_us >= kMaxStamp_us) return true;
  listener_.acceleration(clock_.sync().ToLocal(kNsPerUs * static_cast<std::int64_t>(stamp_us)),
                         FluFromFrd(in_frd));
  return true;
}

bool Autopilot::HandleClimb(const mavlink::Packet& packet) {
  const auto message = packet.As<mavlink::VfrHud>();
  if (!message) return false;
  if (listener_.climb && std::isfinite(message->climb)) listener_.climb(message->climb);
  return true;
}

bool Autopilot::HandleTruePose(const mavlink::Packet& packet, Time received) {
  const auto sim_state = packet.As<mavlink::SimState>();
  const auto hil_state = packet.As<mavlink::HilStateQuaternion>();
  if (!sim_state && !hil_state) return false;
  const auto origin = status_.origin();
  if (!listener_.true_pose || !origin) return true;
  PoseSample pose;
  const PoseFate fate = sim_state
                            ? TruePoseOf(*sim_state, kind_, *origin, clock_.sync(), received, &pose)
                            : TruePoseOf(*hil_state, kind_, *origin, clock_.sync(), &pose);
  if (sim_state) pose.time = BetweenAttitudes(pose.time);
  if (fate == PoseFate::kNotFinite) ReportNotFinite("true pose");
  if (fate == PoseFate::kUsed) listener_.true_pose(pose);
  return true;
}

// Returns the time of a message without a stamp. Its arrival is wrong when the link's delay varies;
// but it was sent between the attitude before it and the next one.
Time Autopilot::BetweenAttitudes(Time guess) const {
  if (!newest_pose_ || options_.attitude_rate_hz == 0) return guess;
  const Duration period = DurationFromSeconds(1 / options_.attitude_rate_hz);
  return std::clamp(guess, *newest_pose_, *newest_pose_ + period);
}

// Messages that come rarely.
void Autopilot::HandleStatus(const mavlink::Packet& packet, Time received) {
  const LandedState before = status_.landed();
  status_.Handle(packet, clock_.sync(), received);
  if (status_.landed() != before) {
    Notify(AutopilotEventKind::kModeChanged, ToString(status_.landed()));
  }
}

void Autopilot::CountLost(const mavlink::Packet& packet) {
  constexpr std::uint8_t kLongestGap = 128;  // a larger gap means out of order
  if (sequence_) {
    const auto gap = static_cast<std::uint8_t>(packet.sequence - *sequence_ - 1);
    if (gap < kLongestGap) counters_.lost_packets += gap;
  }
  sequence_ = packet.sequence;
}

// An autopilot that has started again since the message before has run for no longer than the time
// between the two.
void Autopilot::WatchBoot(const mavlink::Packet& packet, Time received) {
  constexpr double kMargin_s = 2;
  constexpr double kPerSecond = 1000;
  const auto boot_ms = BootTimeIn(packet);
  if (!boot_ms) return;
  const double uptime_s = *boot_ms / kPerSecond;
  const double before_s = boot_ms_ / kPerSecond;
  if (uptime_s + kMargin_s < before_s && uptime_s < ToSeconds(received - stamped_) + kMargin_s) {
    ++reboots_;
  }
  boot_ms_ = *boot_ms;
  stamped_ = received;
}

// Target id 0 addresses everybody.
bool Autopilot::IsForThis(std::uint8_t target_system, std::uint8_t target_component) const {
  return (target_system == 0 || target_system == connection_->system()) &&
         (target_component == 0 || target_component == connection_->component());
}

void Autopilot::HandleAck(const mavlink::CommandAck& message) {
  if (!IsForThis(message.target_system, message.target_component)) return;
  if (const auto ending = commands_.Handle(message)) ReportEnding(*ending);
}

void Autopilot::HandleTimesync(const mavlink::Timesync& message, Time received) {
  if (!IsForThis(message.target_system, message.target_component)) return;
  auto answer = clock_.Handle(message, received);
  if (answer) {
    answer->target_system = system_;
    answer->target_component = component_;
    connection_->Send(*answer);
  }
  WantTimesync();
  if (clock_.sync().jumps() != jumps_) {
    Restart();
    jumps_ = clock_.sync().jumps();
  }
}

// The autopilot's clock has restarted, or was set.
void Autopilot::Restart() {
  ++restarts_;
  clock_.Reset();
  streams_.RequestAgain();
  parameters_.RequestAgain();
  poses_.Reset();
  newest_pose_.reset();
  status_.Reset();
  sequence_.reset();
  questions_ = 0;
  questions_due_ = {};
  Notify(AutopilotEventKind::kRestarted,
         "the autopilot started again: its clock is learned and its streams are requested again");
}

void Autopilot::ReportNotFinite(const char* what) {
  ++counters_.not_finite;
  ReportOnce(AutopilotEventKind::kNotFinite,
             [&] { return fmt::format("the autopilot's {} is not a number: ignored", what); });
}

void Autopilot::Tick(Time now) {
  SendHeartbeat(now);
  if (system_ == 0) return;
  CheckPresence(now);
  if (is_here_) SendRequests(now);
}

void Autopilot::CheckPresence(Time now) {
  if (!is_here_ || ToSeconds(now - heard_) < kAwayAfter_s) return;
  is_here_ = false;
  Notify(AutopilotEventKind::kAway,
         fmt::format("no heartbeat of the autopilot for {:.1f} s", ToSeconds(now - heard_)));
}

void Autopilot::SendHeartbeat(Time now) {
  if (now < heartbeat_due_) return;
  heartbeat_due_ = now + seconds(1);
  mavlink::Heartbeat heartbeat;
  heartbeat.type = mavlink::kTypeOnboardController;
  heartbeat.autopilot = mavlink::kAutopilotInvalid;
  heartbeat.system_status = mavlink::kStateActive;
  constexpr std::uint8_t kMavlinkVersion = 3;
  heartbeat.mavlink_version = kMavlinkVersion;
  connection_->Send(heartbeat);
  if (!options_.poses_as_ground_station) return;
  heartbeat.type = mavlink::kTypeGcs;
  connection_->Send(heartbeat);
}

void Autopilot::WantStreams() {
  streams_.RequestAgain();
  streams_.Want(mavlink::AttitudeQuaternion::kId, options_.attitude_rate_hz);
  streams_.Want(mavlink::LocalPositionNed::kId, options_.position_rate_hz);
  streams_.Want(mavlink::ExtendedSysState::kId, kLandedRate_hz);
  // Not every vehicle has a range sensor.
  streams_.WantIfThere(mavlink::DistanceSensor::kId, kRangeRate_hz);
  if (gimbal_) streams_.WantIfThere(mavlink::GimbalDeviceAttitudeStatus::kId, kGimbalRate_hz);
  if (zoom_) streams_.WantIfThere(mavlink::CameraFovStatus::kId, kZoomRate_hz);
  const bool is_px4 = kind_ == AutopilotKind::kPx4;
  if (options_.points_gimbal) {
    streams_.WantIfThere(mavlink::GimbalManagerStatus::kId, kGimbalControl_hz);
    if (!is_px4) streams_.WantIfThere(mavlink::RcChannels::kId, kGimbalControl_hz);
  }
  streams_.WantIfThere(is_px4 ? mavlink::CurrentMode::kId : mavlink::Heartbeat::kId,
                       options_.mode_rate_hz);
  streams_.WantIfThere(is_px4 ? mavlink::EstimatorStatus::kId : mavlink::EkfStatusReport::kId,
                       kStatusRate_hz);
  streams_.WantIfThere(mavlink::SysStatus::kId, kStatusRate_hz);
  streams_.WantIfThere(mavlink::GpsRawInt::kId,
                       options_.wants_climb ? kGnssRate_hz : kStatusRate_hz);
  if (options_.wants_acceleration) {
    streams_.WantIfThere(is_px4 ? mavlink::HighresImu::kId : mavlink::RawImu::kId,
                         kAcceleration_hz);
  }
  if (options_.wants_acceleration || options_.wants_sticks) {
    streams_.WantIfThere(mavlink::RcChannels::kId, kStatusRate_hz);  // for the guard
  }
  if (options_.wants_climb) streams_.WantIfThere(mavlink::VfrHud::kId, kClimbRate_hz);
  if (options_.wants_true_pose) {
    streams_.Want(is_px4 ? mavlink::HilStateQuaternion::kId : mavlink::SimState::kId,
                  kTruePoseRate_hz);
  }
  WantTimesync();
}

// PX4 trusts stamps after 500 answers, which takes 50 s at the rate of its own requests.
void Autopilot::WantTimesync() {
  constexpr int kTrusted = 600;
  constexpr double kHurry_hz = 100;
  constexpr double kSteady_hz = 10;
  if (kind_ != AutopilotKind::kPx4) return;
  streams_.Want(mavlink::Timesync::kId, clock_.answers() < kTrusted ? kHurry_hz : kSteady_hz);
}

void Autopilot::SendRequests(Time now) {
  if (auto question = clock_.Request(now)) {
    question->target_system = system_;
    question->target_component = component_;
    connection_->Send(*question);
  }
  StreamRequests::Request request;
  if (streams_.Next(now, &request)) SendStreamRequest(request);
  SendCommands(now);
  SendParameterRequests(now);
  SendQuestions(now);
}

void Autopilot::SendParameterRequests(Time now) {
  const std::string_view name = parameters_.Next(now);
  if (!name.empty()) {
    mavlink::ParamRequestRead read;
    read.target_system = system_;
    read.target_component = component_;
    SetText(name, read.param_id);
    read.param_index = -1;
    connection_->Send(read);
  }
  if (auto write = writes_.Next(kind_, parameters_, now)) {
    write->target_system = system_;
    write->target_component = component_;
    connection_->Send(*write);
  }
}

void Autopilot::SetParameter(std::string_view name, double value) {
  if (!parameters_.EntryOf(name)) parameters_.Want(name);
  writes_.Set(name, value);
}

bool Autopilot::RequestMode(FlightMode mode) {
  const std::uint32_t custom_mode = CustomModeOf(kind_, mode);
  if (custom_mode == 0) return false;
  requested_mode_ = custom_mode;
  DropModeRequest();
  commands_.Want(ModeCommand(kind_, custom_mode, system_, component_));
  return true;
}

void Autopilot::DropModeRequest() {
  commands_.Drop(mavlink::kCommandDoSetMode);
  commands_.Drop(mavlink::kCommandLand);
}

void Autopilot::DisarmByForce() {
  commands_.Want(MakeCommand(mavlink::kCommandArmDisarm, 0, mavlink::kArmByForce));
}

void Autopilot::OperateGripper(bool grabs) {
  constexpr float kFirst = 1;
  commands_.Want(MakeCommand(mavlink::kCommandGripper, kFirst,
                             grabs ? mavlink::kGripperGrab : mavlink::kGripperRelease));
}

bool Autopilot::is_gripper_pending() const { return commands_.IsWanted(mavlink::kCommandGripper); }

bool Autopilot::is_request_pending() const {
  return commands_.IsWanted(mavlink::kCommandDoSetMode) ||
         commands_.IsWanted(mavlink::kCommandLand) ||
         commands_.IsWanted(mavlink::kCommandArmDisarm);
}

void Autopilot::SendCommands(Time now) {
  std::optional<CommandRequests::Ending> ended;
  if (const auto command = commands_.Next(now, &ended)) connection_->Send(*command);
  if (ended) ReportEnding(*ended);
}

void Autopilot::ReportEnding(const CommandRequests::Ending& ending) {
  std::string what = "disarming";
  if (IsModeCommand(ending.command.command)) {
    what = "mode " + ModeName(kind_, requested_mode_);
  } else if (ending.command.command == mavlink::kCommandGripper) {
    ++gripper_answers_;
    is_gripper_accepted_ = ending.result && ending.is_accepted();
    what = ending.command.param2 == mavlink::kGripperGrab ? "closing the gripper"
                                                          : "opening the gripper";
  }
  if (!ending.result) {
    Notify(AutopilotEventKind::kCommandUnanswered,
           fmt::format("the autopilot does not answer the request for {}", what));
  } else if (ending.is_accepted()) {
    Notify(AutopilotEventKind::kCommandAccepted, fmt::format("the autopilot accepts {}", what));
  } else {
    Notify(AutopilotEventKind::kCommandRefused,
           fmt::format("the autopilot refuses {}: {}", what, CommandResultName(*ending.result)));
  }
}

// Requests data that are sent once, on request.
void Autopilot::SendQuestions(Time now) {
  constexpr int kQuick = 10;
  constexpr Duration kSlow = seconds(10);
  if (now < questions_due_) return;
  questions_due_ = now + (questions_ < kQuick ? Duration(seconds(1)) : kSlow);
  ++questions_;
  const auto request_message = [&](std::uint32_t id) {
    connection_->Send(MakeCommand(mavlink::kCommandRequestMessage, static_cast<float>(id), 0));
  };
  if (!version() && questions_ < kQuick) request_message(mavlink::AutopilotVersion::kId);
  if (!origin()) request_message(mavlink::GpsGlobalOrigin::kId);
  if (!origin() && kind_ == AutopilotKind::kPx4) request_message(mavlink::Altitude::kId);
  if (!home()) request_message(mavlink::HomePosition::kId);
}

void Autopilot::SendStreamRequest(const StreamRequests::Request& request) {
  SendInterval(request.id, request.rate_hz);
  const bool is_attitude = request.id == mavlink::AttitudeQuaternion::kId;
  if (!is_attitude && request.id != mavlink::LocalPositionNed::kId) return;
  if (request.is_unanswered) SendOldStreamRequest(is_attitude, request.rate_hz);
  constexpr int kManyRequests = 6;
  if (request.requests >= kManyRequests) ReportSlowStream(request);
}

// An autopilot without a position sends none, however fast the line is: ArduCopter for 20 s after
// its estimator has an origin.
void Autopilot::ReportSlowStream(const StreamRequests::Request& request) {
  const bool is_attitude = request.id == mavlink::AttitudeQuaternion::kId;
  if (!is_attitude && request.is_unanswered) {
    return ReportOnce(AutopilotEventKind::kNoPosition, [&] {
      return fmt::format(
          "the autopilot has no position yet{}: it needs GNSS or another source of position, and "
          "some time",
          origin() ? "" : ", its estimator has no origin");
    });
  }
  ReportOnce(AutopilotEventKind::kSlowStream, [&] {
    return fmt::format(
        "the autopilot sends its {} {:.0f} times a second, requested {} times at {:.0f}: is the "
        "line "
        "too slow, or another ground station asking for less?",
        is_attitude ? "attitude" : "position", streams_.RateOf(request.id), request.requests,
        request.rate_hz);
  });
}

// For an autopilot that does not know the message or the command.
void Autopilot::SendOldStreamRequest(bool is_attitude, double rate_hz) {
  if (is_attitude) SendInterval(mavlink::Attitude::kId, rate_hz);
  mavlink::RequestDataStream request;
  request.target_system = system_;
  request.target_component = component_;
  request.req_stream_id = is_attitude ? mavlink::kStreamExtra1 : mavlink::kStreamPosition;
  request.req_message_rate = static_cast<std::uint16_t>(std::lround(rate_hz));
  request.start_stop = 1;
  connection_->Send(request);
}

void Autopilot::SendInterval(std::uint32_t id, double rate_hz) {
  constexpr double kMicroseconds = 1e6;
  connection_->Send(MakeCommand(mavlink::kCommandSetMessageInterval, static_cast<float>(id),
                                static_cast<float>(std::round(kMicroseconds / rate_hz))));
}

mavlink::CommandLong Autopilot::MakeCommand(std::uint16_t command, float param1,
                                            float param2) const {
  mavlink::CommandLong message;
  message.target_system = system_;
  message.target_component = component_;
  message.command = command;
  message.param1 = param1;
  message.param2 = param2;
  return message;
}

void Autopilot::Announce(std::uint8_t severity, std::string_view text) {
  mavlink::Statustext message;
  message.severity = severity;
  const std::size_t piece = message.text.size();
  if (text.size() > piece) message.id = ++text_id_ == 0 ? ++text_id_ : text_id_;
  do {
    SetText(text.substr(0, piece), message.text);
    connection_->Send(message);
    text.remove_prefix(std::min(piece, text.size()));
    ++message.chunk_seq;
  } while (!text.empty());
}

}  // namespace kestrel
