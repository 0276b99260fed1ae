// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/comms/mavlink/autopilot_poses.h"
#include "kestrel/comms/mavlink/autopilot_status.h"
#include "kestrel/comms/mavlink/clock_exchange.h"
#include "kestrel/comms/mavlink/command_requests.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/gimbal_reports.h"
#include "kestrel/comms/mavlink/global_position.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/parameter_reader.h"
#include "kestrel/comms/mavlink/parameter_writer.h"
#include "kestrel/comms/mavlink/stream_requests.h"
#include "kestrel/comms/mavlink/zoom_reports.h"
#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"

namespace kestrel {

struct AutopilotOptions {
  int system_id = 0;
  double attitude_rate_hz = 100;
  double position_rate_hz = 50;
  // Set-points depend on the mode, which must then come more often than once a second with the
  // heartbeat: by more heartbeats, and by CURRENT_MODE, which PX4 sends as soon as it changes.
  double mode_rate_hz = 0;
  bool wants_true_pose = false;                        // which only simulated vehicles know
  std::optional<int> gimbal_device_id = std::nullopt;  // see GimbalReports; nothing: no gimbal
  std::optional<int> zoom_device_id = std::nullopt;    // see ZoomReports; nothing: no zoom
  bool wants_acceleration = false;                     // that the accelerometer measures
  bool wants_sticks = false;                           // how the pilot holds them
  bool wants_climb = false;                            // how fast it climbs
  bool points_gimbal = false;                          // wants what GimbalManager needs
  bool poses_as_ground_station = false;

  static void Visit(auto& self, auto&& visit) {
    visit("system_id", self.system_id, Range{0, 255},
          "MAVLink system of the autopilot; 0: the first that is heard");
    visit("attitude_rate_hz", self.attitude_rate_hz, Range{0, 500},
          "requested rate of attitudes; 0: not requested");
    visit("position_rate_hz", self.position_rate_hz, Range{0, 500}, "requested rate of positions");
    visit("poses_as_ground_station", self.poses_as_ground_station,
          "heartbeats of a ground station are sent, too, so that PX4 sends its texts");
    visit.Gone({"landed_rate_hz", "range_rate_hz", "status_rate_hz", "mode_rate_hz",
                "wants_true_pose", "true_pose_rate_hz", "away_after_s", "position_age_s"});
  }
};

enum class AutopilotEventKind {
  kHeard,              // found
  kAway,               // no heartbeat any more
  kBack,               // heartbeats come again
  kRestarted,          // it has restarted: its clock, and all requests are forgotten
  kModeChanged,        // mode, armed or landed state
  kFailsafe,           // it reports an emergency
  kCommandAccepted,    // a request of this program; no proof that it is carried out
  kCommandRefused,     // with the reason
  kCommandUnanswered,  // after all repetitions
  kOtherAutopilot,     // another autopilot is on the link, and ignored
  kIdClash,            // another program sends with this program's ids
  kOwnIdIsAutopilots,  // this program's ids are the autopilot's: it will ignore every message
  kTargetEcho,         // another program sends landing targets
  kNotFinite,          // an attitude or position is not finite
  kTimeBackwards,      // a message is older than the one before
  kNoTimeSync,         // it does not answer TIMESYNC: its clock is known only roughly
  kSlowStream,         // it sends more slowly than requested
  kNoPosition,         // it sends no position, because it has none
};

// An event that a pilot should know, in words. Each kind from kOtherAutopilot on is reported once.
struct AutopilotEvent {
  AutopilotEventKind kind;
  std::string text;
};

// Counts of received packets that were not used, by reason.
struct AutopilotCounters {
  std::uint64_t lost_packets = 0;  // packets of the autopilot missing by its sequence numbers
  std::uint64_t other_systems = 0;
  std::uint64_t own_ids = 0;
  std::uint64_t target_echoes = 0;
  std::uint64_t not_finite = 0;
  std::uint64_t backwards = 0;
  std::uint64_t without_position = 0;  // attitudes without a recent position
  std::uint64_t without_clock = 0;     // attitudes before the clock was known
};

// Receives poses and texts of an autopilot. All functions are called in the thread that calls
// Handle.
struct AutopilotListener {
  // Body (FLU) in the world (ENU, origin of the autopilot's local frame), on the local clock. One
  // pose for each attitude, with the position of that instant from the newest position and
  // velocity.
  std::function<void(const PoseSample&)> pose;
  std::function<void(const PoseSample&)> true_pose;  // as above, from a simulated vehicle
  std::function<void(const AutopilotEvent&)> event;
  std::function<void(std::uint8_t severity, std::string_view text)> text;  // STATUSTEXT
  std::function<void(const GimbalSample&)> gimbal;                         // on the local clock
  std::function<void(const ZoomSample&)> zoom = {};                        // on the local clock
  // Attitude and turn alone (place and velocity are 0), with or without a position.
  std::function<void(const PoseSample&)> attitude = {};
  // Acceleration that the accelerometer measures, in the body (FLU), m/s^2: with gravity's
  // reaction, upwards at rest. At a time on the local clock.
  std::function<void(Time time, const Eigen::Vector3d& acceleration)> acceleration = {};
  // Climb rate by the autopilot's estimate, m/s: with a barometer it needs no position.
  std::function<void(double climb_mps)> climb = {};
};

// The autopilot at the other end of a connection: finds it, follows its state, requests what is
// needed as often as necessary, and learns its clock. Driven by one thread:
//
//   connection.Receive(timeout, [&](const auto& packet, Time time) {
//     autopilot.Handle(packet, time);
//   });
//   autopilot.Tick(Now());
//
// Malformed bytes neither throw nor crash; after the first seconds no message allocates.
class Autopilot {
 public:
  // 'connection' must outlive this. Throws InputError when the options are not valid.
  Autopilot(const AutopilotOptions& options, Connection* connection, AutopilotListener listener);

  void Handle(const mavlink::Packet& packet, Time received);
  // Sends what is due: heartbeats, requests, TIMESYNC. Call it about every 10 ms.
  void Tick(Time now);

  // True when a heartbeat was heard recently.
  bool is_here() const { return is_here_; }
  Time mode_reported() const { return mode_reported_; }  // newest heartbeat, or PX4's CURRENT_MODE
  Time received() const { return received_; }            // time of the newest message
  AutopilotKind kind() const { return kind_; }
  std::uint8_t system() const { return system_; }
  std::uint8_t component() const { return component_; }
  std::uint32_t custom_mode() const { return heartbeat_.custom_mode; }
  std::string mode_name() const { return ModeName(kind_, heartbeat_.custom_mode); }
  bool is_landing_mode() const { return IsLandingMode(kind_, heartbeat_.custom_mode); }
  bool is_descent() const { return IsDescent(kind_, heartbeat_.custom_mode); }
  bool is_guided_mode() const { return IsGuidedMode(kind_, heartbeat_.custom_mode); }
  bool is_armed() const;
  // True when it reports an emergency and carries out its failsafe.
  bool is_in_failsafe() const;
  std::uint8_t vehicle_type() const { return heartbeat_.type; }  // MAV_TYPE
  bool is_multicopter() const { return IsMulticopter(heartbeat_.type); }
  LandedState landed_state() const { return status_.landed(); }
  // The autopilot's reports about itself, as far as they came.
  const AutopilotStatus& status() const { return status_; }
  std::optional<AutopilotVersion> version() const { return status_.version(); }
  std::optional<AutopilotRange> range() const { return status_.range(); }
  std::optional<GlobalPosition> origin() const { return status_.origin(); }  // local frame
  std::optional<GlobalPosition> home() const { return status_.home(); }
  std::optional<AutopilotBattery> battery() const { return status_.battery(); }
  // True when the autopilot trusts its own attitude, velocity and position; nothing when it does
  // not report this, or has not for 'away_after_s'.
  std::optional<bool> is_position_good(Time now) const;

  const TimeSync& time_sync() const { return clock_.sync(); }
  const StreamRequests& streams() const { return streams_; }
  ParameterReader& parameters() { return parameters_; }
  const ParameterReader& parameters() const { return parameters_; }
  const ParameterWriter& parameter_writes() const { return writes_; }
  const AutopilotCounters& counters() const { return counters_; }
  int restarts() const { return restarts_; }  // its clock began anew, or was set
  // Number of times that it has started again: its time since boot began anew. A clock that was
  // only set back does not count.
  int reboots() const { return reboots_; }
  Time stamped() const { return stamped_; }  // newest message with its time since boot

  // Requests this mode until an answer comes, which an event reports; the reported mode shows
  // whether it was entered. Stops at once when the autopilot enters another mode: somebody else
  // wants that one. False: this kind of autopilot takes no such request.
  bool RequestMode(FlightMode mode);
  // Stops the motors at once, also in flight.
  void DisarmByForce();
  // True while the answer to one of the two is awaited.
  bool is_request_pending() const;
  // Closes or opens the first gripper.
  void OperateGripper(bool grabs);
  bool is_gripper_pending() const;  // the answer is awaited
  // Number of answers so far, and whether the newest one is that the autopilot does it. One that
  // never answers has refused.
  int gripper_answers() const { return gripper_answers_; }
  bool is_gripper_accepted() const { return is_gripper_accepted_; }

  // Sets a parameter by its first name and in that name's unit (parameter_names.h). Repeats it
  // until the autopilot reports the value back: parameter_writes() has the outcome.
  void SetParameter(std::string_view name, double value);

  // Sends a text to the ground station, in pieces of 50 characters if it is longer. 'severity':
  // MAV_SEVERITY.
  void Announce(std::uint8_t severity, std::string_view text);

 private:
  bool IsFromAutopilot(const mavlink::Packet& packet);
  bool IsForThis(std::uint8_t target_system, std::uint8_t target_component) const;
  void HandleHeartbeat(const mavlink::Packet& packet, const mavlink::Heartbeat& heartbeat,
                       Time received);
  void Adopt(const mavlink::Packet& packet, const mavlink::Heartbeat& heartbeat);
  void ReportChange(const mavlink::Heartbeat& before);
  void HandleFromAutopilot(const mavlink::Packet& packet, Time received);
  void HandleGimbal(const mavlink::Packet& packet, Time received);
  void HandleZoom(const mavlink::Packet& packet, Time received);
  bool HandlePose(const mavlink::Packet& packet, Time received);
  bool HandleTruePose(const mavlink::Packet& packet, Time received);
  bool HandleAcceleration(const mavlink::Packet& packet);
  bool HandleClimb(const mavlink::Packet& packet);
  void ReportPose(PoseFate fate, const char* what, const PoseSample& pose);
  void ReportAttitude(PoseSample pose);
  Time BetweenAttitudes(Time guess) const;
  void HandleStatus(const mavlink::Packet& packet, Time received);
  void HandleTimesync(const mavlink::Timesync& message, Time received);
  void HandleAck(const mavlink::CommandAck& message);
  void CountLost(const mavlink::Packet& packet);
  void WatchBoot(const mavlink::Packet& packet, Time received);
  void ReportNotFinite(const char* what);
  void Restart();
  void CheckPresence(Time now);
  void SendHeartbeat(Time now);
  void SendRequests(Time now);
  void WantStreams();
  void WantTimesync();
  void ReportSlowStream(const StreamRequests::Request& request);
  void SendStreamRequest(const StreamRequests::Request& request);
  void SendOldStreamRequest(bool is_attitude, double rate_hz);
  void SendInterval(std::uint32_t id, double rate_hz);
  mavlink::CommandLong MakeCommand(std::uint16_t command, float param1, float param2) const;
  void SendCommands(Time now);
  void DropModeRequest();
  void ReportEnding(const CommandRequests::Ending& ending);
  void SendParameterRequests(Time now);
  void SendQuestions(Time now);
  void Notify(AutopilotEventKind kind, std::string text);
  template <class Text>
  void ReportOnce(AutopilotEventKind kind, const Text& make_text);

  AutopilotOptions options_;
  Connection* connection_;
  AutopilotListener listener_;

  bool is_here_ = false;
  std::uint8_t system_ = 0;  // 0: none was heard yet
  std::uint8_t component_ = 0;
  AutopilotKind kind_ = AutopilotKind::kUnknown;
  mavlink::Heartbeat heartbeat_;
  Time heard_{};
  Time received_{};
  Time mode_reported_{};
  std::optional<std::uint8_t> sequence_;

  ClockExchange clock_;
  int jumps_ = 0;  // number of jumps of the clock that were seen
  AutopilotStatus status_;
  AutopilotPoses poses_;
  std::optional<GimbalReports> gimbal_;
  std::optional<ZoomReports> zoom_;
  std::optional<Time> newest_pose_;
  StreamRequests streams_;
  CommandRequests commands_;
  std::uint32_t requested_mode_ = 0;
  int gripper_answers_ = 0;
  bool is_gripper_accepted_ = false;
  ParameterReader parameters_;
  ParameterWriter writes_;

  Time heartbeat_due_{};
  Time questions_due_{};
  int questions_ = 0;
  std::uint16_t text_id_ = 0;
  AutopilotCounters counters_;
  int restarts_ = 0;
  int reboots_ = 0;
  std::uint32_t boot_ms_ = 0;  // its time since boot at stamped_
  Time stamped_{};
  std::uint32_t reported_ = 0;  // one bit for each kind that is reported once
};

}  // namespace kestrel
