// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/link/autopilot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "kestrel/base/options.h"
#include "kestrel/base/violations.h"
#include "kestrel/link/mavlink_enums.h"
#include "kestrel/link/ned.h"

namespace kestrel {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using std::chrono::seconds;

constexpr double kHalfMillisecond_ms = 0.5;

// Stamps in milliseconds are cut off: half of one is missing on average.
std::int64_t RemoteNanoseconds(std::uint32_t boot_ms) {
  constexpr double kNsPerMs = 1e6;
  return static_cast<std::int64_t>((boot_ms + kHalfMillisecond_ms) * kNsPerMs);
}

// Signed, s; right over the wrap after 49 days.
double SecondsBetween(std::uint32_t from_ms, std::uint32_t to_ms) {
  return 1e-3 * static_cast<std::int32_t>(to_ms - from_ms);
}

Quaterniond FromEulerAngles(double roll, double pitch, double yaw) {
  return Quaterniond(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(pitch, Vector3d::UnitY()) *
                     Eigen::AngleAxisd(roll, Vector3d::UnitX()));
}

bool IsRotation(const Quaterniond& rotation) {
  constexpr double kTolerance = 0.01;
  return std::abs(rotation.norm() - 1) < kTolerance;  // false for NaN
}

bool IsAutopilotHeartbeat(const mavlink::Heartbeat& heartbeat) {
  return heartbeat.autopilot != mavlink::kAutopilotInvalid && heartbeat.type != mavlink::kTypeGcs &&
         heartbeat.type != mavlink::kTypeOnboardController;
}

LandedState LandedStateOf(std::uint8_t state) {
  switch (state) {
    case mavlink::kLandedOnGround:
      return LandedState::kOnGround;
    case mavlink::kLandedInAir:
      return LandedState::kInAir;
    case mavlink::kLandedTakeoff:
      return LandedState::kTakingOff;
    case mavlink::kLandedLanding:
      return LandedState::kLanding;
    default:
      return LandedState::kUnknown;
  }
}

}  // namespace

const char* ToString(LandedState state) {
  switch (state) {
    case LandedState::kUnknown:
      return "unknown";
    case LandedState::kOnGround:
      return "on ground";
    case LandedState::kInAir:
      return "in air";
    case LandedState::kTakingOff:
      return "taking off";
    case LandedState::kLanding:
      return "landing";
  }
  return "";
}

std::vector<std::string> AutopilotOptions::Validate() const {
  constexpr int kMaxId = 255;
  constexpr double kMaxRate_hz = 500;
  std::vector<std::string> violations;
  RequireIn(system_id, 0, kMaxId, "system_id", &violations);
  RequireIn(attitude_rate_hz, 0, kMaxRate_hz, "attitude_rate_hz", &violations);
  RequireIn(position_rate_hz, 0, kMaxRate_hz, "position_rate_hz", &violations);
  RequireIn(landed_rate_hz, 0, kMaxRate_hz, "landed_rate_hz", &violations);
  RequireIn(range_rate_hz, 0, kMaxRate_hz, "range_rate_hz", &violations);
  RequireIn(true_pose_rate_hz, 0, kMaxRate_hz, "true_pose_rate_hz", &violations);
  RequirePositive(away_after_s, "away_after_s", &violations);
  RequirePositive(position_age_s, "position_age_s", &violations);
  return violations;
}

Autopilot::Autopilot(const AutopilotOptions& options, Connection* connection,
                     AutopilotListener listener)
    : options_(options), connection_(connection), listener_(std::move(listener)) {
  RequireValid(options);
}

bool Autopilot::is_armed() const { return (heartbeat_.base_mode & mavlink::kModeFlagArmed) != 0; }

void Autopilot::Tell(AutopilotEventKind kind, std::string text) {
  if (listener_.event) listener_.event({kind, std::move(text)});
}

template <class Text>
void Autopilot::TellOnce(AutopilotEventKind kind, const Text& make_text) {
  const std::uint32_t bit = 1u << static_cast<unsigned>(kind);
  if ((told_ & bit) != 0) return;
  told_ |= bit;
  Tell(kind, make_text());
}

void Autopilot::Handle(const mavlink::Packet& packet, Time received) {
  if (const auto heartbeat = packet.As<mavlink::Heartbeat>()) {
    HandleHeartbeat(packet, *heartbeat, received);
  }
  if (packet.system == connection_->system() && packet.component == connection_->component() &&
      !(packet.system == system_ && packet.component == component_)) {
    ++counters_.own_ids;
    TellOnce(AutopilotEventKind::kIdClash, [&] {
      return fmt::format(
          "somebody else sends as system {} component {}, or the link sends our own messages back: "
          "they are ignored",
          packet.system, packet.component);
    });
    return;
  }
  if (packet.id == mavlink::LandingTarget::kId) {
    ++counters_.target_echoes;
    TellOnce(AutopilotEventKind::kTargetEcho, [&] {
      return fmt::format("system {} component {} sends landing targets too: they are ignored",
                         packet.system, packet.component);
    });
    return;
  }
  if (IsFromAutopilot(packet)) HandleFromAutopilot(packet, received);
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
    TellOnce(AutopilotEventKind::kOtherAutopilot, [&] {
      return fmt::format(
          "another autopilot, system {} component {}, is on the link: only system {} component {} "
          "is listened to",
          packet.system, packet.component, system_, component_);
    });
    return;
  }
  const bool has_changed =
      heartbeat.custom_mode != heartbeat_.custom_mode ||
      ((heartbeat.base_mode ^ heartbeat_.base_mode) & mavlink::kModeFlagArmed) != 0;
  heartbeat_ = heartbeat;
  heard_ = received;
  if (!is_here_) {
    is_here_ = true;
    const bool is_first = kind_ == AutopilotKind::kUnknown;
    kind_ = AutopilotKindOf(heartbeat.autopilot);
    WantStreams();
    Tell(is_first ? AutopilotEventKind::kHeard : AutopilotEventKind::kBack,
         fmt::format("{} (system {}) {}, {}, {}", ToString(kind_), system_,
                     is_first ? "heard" : "is back", mode_name(),
                     is_armed() ? "armed" : "disarmed"));
  } else if (has_changed) {
    Tell(AutopilotEventKind::kModeChanged,
         fmt::format("mode {}, {}", mode_name(), is_armed() ? "armed" : "disarmed"));
  }
}

void Autopilot::Adopt(const mavlink::Packet& packet, const mavlink::Heartbeat& heartbeat) {
  system_ = packet.system;
  component_ = packet.component;
  heartbeat_ = heartbeat;
  if (connection_->takes_system_of_autopilot()) connection_->SetSystem(system_);
  if (connection_->system() == system_ && connection_->component() == component_) {
    TellOnce(AutopilotEventKind::kOwnIdIsAutopilots, [&] {
      return fmt::format(
          "system {} component {} is the autopilot itself, which ignores whoever sends as it: "
          "expected another component_id, as 191",
          system_, component_);
    });
  }
}

void Autopilot::HandleFromAutopilot(const mavlink::Packet& packet, Time received) {
  CountLost(packet);
  streams_.Count(packet.id);
  if (const auto timesync = packet.As<mavlink::Timesync>()) {
    HandleTimesync(*timesync, received);
  } else if (const auto quaternion = packet.As<mavlink::AttitudeQuaternion>()) {
    HandleQuaternion(*quaternion, received);
  } else if (const auto attitude = packet.As<mavlink::Attitude>()) {
    HandleEulerAngles(*attitude, received);
  } else if (const auto position = packet.As<mavlink::LocalPositionNed>()) {
    HandlePosition(*position);
  } else if (const auto sim_state = packet.As<mavlink::SimState>()) {
    HandleSimState(*sim_state, received);
  } else if (const auto hil_state = packet.As<mavlink::HilStateQuaternion>()) {
    HandleHilState(*hil_state);
  } else {
    HandleState(packet);
  }
}

// Messages that come seldom.
void Autopilot::HandleState(const mavlink::Packet& packet) {
  if (const auto state = packet.As<mavlink::ExtendedSysState>()) HandleExtendedState(*state);
  if (const auto range = packet.As<mavlink::DistanceSensor>()) HandleRange(*range);
  if (const auto value = packet.As<mavlink::ParamValue>()) parameters_.Handle(kind_, *value);
  if (const auto origin = packet.As<mavlink::GpsGlobalOrigin>()) {
    origin_ = {origin->latitude, origin->longitude, 1e-3 * origin->altitude};
  }
  if (const auto version = packet.As<mavlink::AutopilotVersion>()) {
    const std::uint32_t number = version->flight_sw_version;
    version_ =
        AutopilotVersion{static_cast<int>(number >> 24), static_cast<int>(number >> 16 & 0xff),
                         static_cast<int>(number >> 8 & 0xff)};
  }
  const auto text = packet.As<mavlink::Statustext>();
  if (text && listener_.text) listener_.text(text->severity, TextOf(text->text));
}

void Autopilot::CountLost(const mavlink::Packet& packet) {
  constexpr std::uint8_t kLongestGap = 128;  // more is out of order
  if (sequence_) {
    const auto gap = static_cast<std::uint8_t>(packet.sequence - *sequence_ - 1);
    if (gap < kLongestGap) counters_.lost_packets += gap;
  }
  sequence_ = packet.sequence;
}

void Autopilot::HandleTimesync(const mavlink::Timesync& message, Time received) {
  const auto is_other = [](std::uint8_t told, std::uint8_t own) {
    return told != 0 && told != own;
  };
  if (is_other(message.target_system, connection_->system()) ||
      is_other(message.target_component, connection_->component())) {
    return;
  }
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

// The autopilot's clock began anew, or was set.
void Autopilot::Restart() {
  ++restarts_;
  clock_.Reset();
  streams_.AskAgain();
  parameters_.AskAgain();
  position_.reset();
  origin_.reset();
  version_.reset();
  range_.reset();
  sequence_.reset();
  attitude_order_ = euler_order_ = position_order_ = {};
  landed_ = LandedState::kUnknown;
  questions_ = 0;
  questions_due_ = {};
  Tell(AutopilotEventKind::kRestarted,
       "the autopilot started again: its clock is learned and its streams are asked for anew");
}

// Packets overtake each other by some milliseconds; several in a row that are older come from a
// clock that began anew.
bool Autopilot::IsNewer(std::uint32_t boot_ms, StampOrder* order) {
  constexpr int kRestartAfter = 3;
  constexpr double kRestartBack_s = 1;
  if (!order->newest_ms || SecondsBetween(*order->newest_ms, boot_ms) > 0) {
    *order = {boot_ms, 0};
    return true;
  }
  const double back_s = SecondsBetween(boot_ms, *order->newest_ms);
  if (back_s == 0) return false;  // sent twice
  ++counters_.backwards;
  order->backwards = back_s > kRestartBack_s ? order->backwards + 1 : 0;
  if (order->backwards == kRestartAfter) {
    Restart();
    return true;
  }
  TellOnce(AutopilotEventKind::kTimeBackwards, [&] {
    return fmt::format("a message of the autopilot is {:.3f} s older than the one before: ignored",
                       back_s);
  });
  return false;
}

bool Autopilot::IsFinite(bool is_finite, const char* what) {
  if (is_finite) return true;
  ++counters_.not_finite;
  TellOnce(AutopilotEventKind::kNotFinite,
           [&] { return fmt::format("the autopilot's {} is not a number: ignored", what); });
  return false;
}

void Autopilot::HandleQuaternion(const mavlink::AttitudeQuaternion& message, Time received) {
  const Quaterniond rotation(message.q1, message.q2, message.q3, message.q4);
  const Vector3d rate(message.rollspeed, message.pitchspeed, message.yawspeed);
  if (!IsFinite(IsRotation(rotation) && rate.allFinite(), "attitude")) return;
  if (!IsNewer(message.time_boot_ms, &attitude_order_)) return;
  has_quaternions_ = true;
  HandleAttitude({message.time_boot_ms, rotation.normalized(), rate}, received);
}

// Of an autopilot that sends both, the quaternions are used.
void Autopilot::HandleEulerAngles(const mavlink::Attitude& message, Time received) {
  constexpr double kQuaternionsEnd_s = 0.5;
  const Vector3d angles(message.roll, message.pitch, message.yaw);
  const Vector3d rate(message.rollspeed, message.pitchspeed, message.yawspeed);
  if (!IsFinite(angles.allFinite() && rate.allFinite(), "attitude")) return;
  if (!IsNewer(message.time_boot_ms, &euler_order_)) return;
  if (has_quaternions_ && attitude_order_.newest_ms &&
      SecondsBetween(*attitude_order_.newest_ms, message.time_boot_ms) < kQuaternionsEnd_s) {
    return;
  }
  has_quaternions_ = false;
  HandleAttitude({message.time_boot_ms, FromEulerAngles(angles.x(), angles.y(), angles.z()), rate},
                 received);
}

void Autopilot::HandleAttitude(const AttitudeSample& sample, Time received) {
  clock_.HandleStamp(RemoteNanoseconds(sample.boot_ms), received);
  if (!clock_.sync().is_known()) {
    ++counters_.without_clock;
    return;
  }
  if (clock_.is_one_way()) {
    TellOnce(AutopilotEventKind::kNoTimeSync, [] {
      return std::string(
          "the autopilot does not answer TIMESYNC: its clock is known by the delay of the line "
          "only");
    });
  }
  const double age_s = position_ ? SecondsBetween(position_->boot_ms, sample.boot_ms) : 0;
  if (!position_ || std::abs(age_s) > options_.position_age_s) {
    ++counters_.without_position;
    return;
  }
  if (!listener_.pose) return;
  PoseSample pose;
  pose.time = clock_.sync().ToLocal(RemoteNanoseconds(sample.boot_ms));
  pose.world_from_body = {EnuFluFromNedFrd(sample.ned_from_frd).normalized(),
                          position_->in_world + age_s * position_->velocity_in_world};
  pose.motion = BodyMotion{position_->velocity_in_world, FluFromFrd(sample.rate_in_frd)};
  listener_.pose(pose);
}

void Autopilot::HandlePosition(const mavlink::LocalPositionNed& message) {
  const Vector3d position(message.x, message.y, message.z);
  const Vector3d velocity(message.vx, message.vy, message.vz);
  if (!IsFinite(position.allFinite() && velocity.allFinite(), "position")) return;
  if (!IsNewer(message.time_boot_ms, &position_order_)) return;
  position_ = {message.time_boot_ms, EnuFromNed(position), EnuFromNed(velocity)};
}

// SIM_STATE has no time of its own: it was sent when the fastest message would have had to be.
void Autopilot::HandleSimState(const mavlink::SimState& message, Time received) {
  if (!listener_.true_pose || !origin_ || !clock_.sync().is_known()) return;
  const Quaterniond rotation(message.q1, message.q2, message.q3, message.q4);
  const Vector3d velocity(message.vn, message.ve, message.vd);
  const Vector3d rate(message.xgyro, message.ygyro, message.zgyro);
  const bool is_finite = IsRotation(rotation) && velocity.allFinite() && rate.allFinite() &&
                         std::isfinite(message.alt);
  if (!IsFinite(is_finite, "true pose")) return;
  PoseSample pose;
  pose.time = received - clock_.sync().round_trip() / 2;
  pose.world_from_body = {
      EnuFluFromNedFrd(rotation).normalized(),
      LocalFromGlobal(kind_, *origin_, {message.lat_int, message.lon_int, message.alt})};
  pose.motion = BodyMotion{EnuFromNed(velocity), FluFromFrd(rate)};
  listener_.true_pose(pose);
}

void Autopilot::HandleHilState(const mavlink::HilStateQuaternion& message) {
  constexpr std::uint64_t kMaxStamp_us = std::uint64_t{1} << 50;
  if (!listener_.true_pose || !origin_ || !clock_.sync().is_known()) return;
  const auto& q = message.attitude_quaternion;
  const Quaterniond rotation(q[0], q[1], q[2], q[3]);
  const Vector3d rate(message.rollspeed, message.pitchspeed, message.yawspeed);
  const bool is_finite =
      IsRotation(rotation) && rate.allFinite() && message.time_usec < kMaxStamp_us;
  if (!IsFinite(is_finite, "true pose")) return;
  PoseSample pose;
  pose.time = clock_.sync().ToLocal(static_cast<std::int64_t>(1000 * message.time_usec));
  pose.world_from_body = {
      EnuFluFromNedFrd(rotation).normalized(),
      LocalFromGlobal(kind_, *origin_, {message.lat, message.lon, 1e-3 * message.alt})};
  pose.motion =
      BodyMotion{EnuFromNed(Vector3d(message.vx, message.vy, message.vz) / 100), FluFromFrd(rate)};
  listener_.true_pose(pose);
}

void Autopilot::HandleExtendedState(const mavlink::ExtendedSysState& message) {
  const LandedState landed = LandedStateOf(message.landed_state);
  if (landed == landed_) return;
  landed_ = landed;
  Tell(AutopilotEventKind::kModeChanged, ToString(landed));
}

void Autopilot::HandleRange(const mavlink::DistanceSensor& message) {
  if (message.orientation != mavlink::kOrientationDown || !clock_.sync().is_known()) return;
  if (message.current_distance < message.min_distance ||
      message.current_distance > message.max_distance) {
    return;
  }
  range_ = {clock_.sync().ToLocal(RemoteNanoseconds(message.time_boot_ms)),
            1e-2 * message.current_distance};
}

void Autopilot::Tick(Time now) {
  SendHeartbeat(now);
  if (system_ == 0) return;
  CheckPresence(now);
  if (is_here_) SendRequests(now);
}

void Autopilot::CheckPresence(Time now) {
  if (!is_here_ || ToSeconds(now - heard_) < options_.away_after_s) return;
  is_here_ = false;
  Tell(AutopilotEventKind::kAway,
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
  streams_.AskAgain();
  streams_.Want(mavlink::AttitudeQuaternion::kId, options_.attitude_rate_hz);
  streams_.Want(mavlink::LocalPositionNed::kId, options_.position_rate_hz);
  streams_.Want(mavlink::ExtendedSysState::kId, options_.landed_rate_hz);
  streams_.Want(mavlink::DistanceSensor::kId, options_.range_rate_hz);
  if (options_.wants_true_pose) {
    const bool is_px4 = kind_ == AutopilotKind::kPx4;
    streams_.Want(is_px4 ? mavlink::HilStateQuaternion::kId : mavlink::SimState::kId,
                  options_.true_pose_rate_hz);
  }
  WantTimesync();
}

// PX4 trusts stamps after 500 answers, which takes it 50 s at the rate at which it asks by itself.
void Autopilot::WantTimesync() {
  constexpr int kTrusted = 600;
  constexpr double kHurry_hz = 100;
  constexpr double kSteady_hz = 10;
  if (kind_ != AutopilotKind::kPx4) return;
  streams_.Want(mavlink::Timesync::kId, clock_.answers() < kTrusted ? kHurry_hz : kSteady_hz);
}

void Autopilot::SendRequests(Time now) {
  if (auto question = clock_.Ask(now)) {
    question->target_system = system_;
    question->target_component = component_;
    connection_->Send(*question);
  }
  StreamRequests::Request request;
  if (streams_.Next(now, &request)) SendStreamRequest(request);
  const std::string_view name = parameters_.Next(now);
  if (!name.empty()) {
    mavlink::ParamRequestRead read;
    read.target_system = system_;
    read.target_component = component_;
    SetText(name, read.param_id);
    read.param_index = -1;
    connection_->Send(read);
  }
  SendQuestions(now);
}

// What is told once, when it is asked for.
void Autopilot::SendQuestions(Time now) {
  constexpr int kQuick = 10;
  constexpr Duration kSlow = seconds(10);
  if (now < questions_due_) return;
  questions_due_ = now + (questions_ < kQuick ? Duration(seconds(1)) : kSlow);
  ++questions_;
  const auto ask = [&](std::uint32_t id) {
    SendCommand(mavlink::kCommandRequestMessage, static_cast<float>(id), 0);
  };
  if (!version_ && questions_ < kQuick) ask(mavlink::AutopilotVersion::kId);
  if (!origin_) ask(mavlink::GpsGlobalOrigin::kId);
}

void Autopilot::SendStreamRequest(const StreamRequests::Request& request) {
  SendInterval(request.id, request.rate_hz);
  const bool is_attitude = request.id == mavlink::AttitudeQuaternion::kId;
  if (!is_attitude && request.id != mavlink::LocalPositionNed::kId) return;
  if (request.is_unanswered) SendOldStreamRequest(is_attitude, request.rate_hz);
  constexpr int kManyRequests = 6;
  if (request.requests < kManyRequests) return;
  TellOnce(AutopilotEventKind::kSlowStream, [&] {
    return fmt::format(
        "the autopilot tells its {} {:.0f} times a second, asked {} times for {:.0f}: is the line "
        "too slow, or another ground station asking for less?",
        is_attitude ? "attitude" : "position", streams_.RateOf(request.id), request.requests,
        request.rate_hz);
  });
}

// For an autopilot that does not know the message, or not the command.
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
  SendCommand(mavlink::kCommandSetMessageInterval, static_cast<float>(id),
              static_cast<float>(std::round(kMicroseconds / rate_hz)));
}

void Autopilot::SendCommand(std::uint16_t command, float param1, float param2) {
  mavlink::CommandLong message;
  message.target_system = system_;
  message.target_component = component_;
  message.command = command;
  message.param1 = param1;
  message.param2 = param2;
  connection_->Send(message);
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
