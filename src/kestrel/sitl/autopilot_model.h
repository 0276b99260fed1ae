// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/base/random.h"
#include "kestrel/base/time.h"
#include "kestrel/flight/navigation_model.h"
#include "kestrel/navigation/set_point.h"
#include "kestrel/sitl/autopilot_messages.h"
#include "kestrel/sitl/autopilot_parameters.h"
#include "kestrel/sitl/landing_rules.h"
#include "kestrel/sitl/message_streams.h"
#include "kestrel/sitl/px4_time_sync.h"
#include "kestrel/sitl/simulated_uav.h"
#include "kestrel/sitl/vehicle_world.h"

namespace kestrel {

// What the simulated pilot does: keeps the UAV beside the pattern, then switches to the mode that
// lands. Commands from the link take over.
struct PilotOptions {
  double start_altitude_m = 10;  // above the pattern; 0: disarmed on the ground at the origin
  double offset_east_m = 2;      // of the UAV from the pattern
  double offset_north_m = -1;
  double heading_deg = 60;      // of its nose, clockwise from north
  double land_after_s = 5;      // negative: never
  bool follows_vehicle = true;  // until then, as a pilot does by eye; else it hovers

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("start_altitude_m", self.start_altitude_m, "m",
            "above the pattern at the start; 0: disarmed on the ground at the origin");
    visitor("offset_east_m", self.offset_east_m, "m", "of the UAV from the pattern at the start");
    visitor("offset_north_m", self.offset_north_m, "m", "of the UAV from the pattern at the start");
    visitor("heading_deg", self.heading_deg, "deg", "of its nose, clockwise from north");
    visitor("land_after_s", self.land_after_s, "s",
            "when the pilot switches to the mode that lands; negative: never");
    visitor("follows_vehicle", self.follows_vehicle, "",
            "the pilot flies along with the vehicle until then; else the UAV hovers");
  }
  std::vector<std::string> Validate() const;
};

struct AutopilotModelOptions {
  AutopilotModelOptions();

  int system_id = 1;
  double uptime_s = 100;   // its own clock at the start
  double drift_ppm = 0;    // by which its clock is fast
  std::string parameters;  // "NAME=value,NAME=value": other than the defaults
  SimulatedUavOptions uav;
  NavigationOptions navigation;  // errors of its estimate
  GlobalOrigin origin;
  PilotOptions pilot;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("system_id", self.system_id, "1", "its MAVLink system id");
    visitor("uptime_s", self.uptime_s, "s", "its own clock at the start");
    visitor("drift_ppm", self.drift_ppm, "ppm", "by which its clock is fast");
    visitor("parameters", self.parameters, "", "NAME=value,NAME=value: other than the defaults");
    visitor.Group("uav", self.uav);
    visitor.Group("navigation", self.navigation);
    visitor.Group("origin", self.origin);
    visitor.Group("pilot", self.pilot);
  }
  std::vector<std::string> Validate() const;
};

// How a landing went.
struct SitlResult {
  std::optional<Contact> contact;  // in the mode that lands
  double landing_s = 0;            // from the switch to that mode until contact
  bool is_disarmed = false;        // after contact, not by force
  double disarm_s = 0;             // from contact

  // Of the feet's middle from the pattern's centre, m; only with a contact.
  double offset_m() const { return contact->feet_in_pattern.head<2>().norm(); }
};

// A line: "came down on the board, 0.03 m from the centre, after 18.2 s; disarmed 2.1 s later".
std::string InWords(const SitlResult& result);

// A UAV with its autopilot, as far as a companion computer can tell it from a real one: its clock,
// messages, modes, parameters, and how it lands by what it is told. Steps on whatever clock it is
// given; no thread, no socket.
class AutopilotModel {
 public:
  using Send = std::function<void(const AutopilotMessage& message)>;

  // The world must outlive it. Throws InputError when the options are not valid, or name a
  // parameter that does not exist.
  AutopilotModel(AutopilotFirmware firmware, const AutopilotModelOptions& options,
                 VehicleWorld* world, Time start, std::uint64_t seed, Send send);

  // Goes on to 'now' on the local clock, in steps of 4 ms.
  void Step(Time now);

  // A message from 'system', 'component' arrived at 'now'.
  void Handle(const CompanionMessage& message, std::uint8_t system, std::uint8_t component,
              Time now);

  // Injected faults.
  void Reboot(Time now);            // of all but the flight: clock, streams, and silent for a while
  void JumpClock(Duration change);  // of its own clock
  void set_nan_attitude(bool nan) { nan_attitude_ = nan; }

  // Its own clock, ns since boot.
  std::int64_t OwnTime(Time now) const;

  const PoseSample& truth() const { return uav_.pose(); }  // at the last step
  std::uint32_t custom_mode() const { return custom_mode_; }
  bool is_armed() const { return is_armed_; }
  const SitlResult& result() const { return result_; }
  AutopilotParameters& parameters() { return parameters_; }

 private:
  void StepOnce(Time now);
  void ObserveFlight(Time now);
  SetPoint Fly(Time now);
  SetPoint FollowVehicle(Time now) const;
  SetPoint Hold() const;
  void FollowScript(Time now);
  void EnterMode(std::uint32_t custom_mode, Time now);
  bool Lands() const;
  void FinishLanding(Time now);
  bool SendMessage(std::uint32_t id, Time now);
  void Say(Severity severity, const std::string& text) const;
  std::int64_t OwnMicroseconds(Time now) const { return OwnTime(now) / 1000; }
  std::uint8_t LandedState() const;
  mavlink::Heartbeat HeartbeatOf() const;
  mavlink::AutopilotVersion VersionOf() const;

  void Receive(const mavlink::Heartbeat& message, Time now);
  void Receive(const mavlink::CommandLong& message, Time now);
  void Receive(const mavlink::SetMode& message, Time now);
  void Receive(const mavlink::Timesync& message, Time now);
  void Receive(const mavlink::LandingTarget& message, Time now);
  void Receive(const mavlink::TargetRelative& message, Time now);
  void Receive(const mavlink::ParamRequestRead& message, Time now);
  void Receive(const mavlink::ParamRequestList& message, Time now);
  void Receive(const mavlink::ParamSet& message, Time now);

  std::uint8_t Execute(const mavlink::CommandLong& command, Time now);
  std::uint8_t SetModeBy(const mavlink::CommandLong& command, Time now);
  std::uint8_t Arm(bool arm, bool by_force);
  std::uint8_t TakeOff(double altitude, Time now);

  AutopilotFirmware firmware_;
  AutopilotModelOptions options_;
  VehicleWorld& world_;
  Send send_;
  Random random_;
  AutopilotParameters parameters_;
  SimulatedUav uav_;
  NavigationSensor navigation_;
  Px4TimeSync px4_clock_;
  std::unique_ptr<LandingRules> rules_;
  MessageStreams streams_;

  Time start_;
  Time stepped_to_;
  Time booted_at_;
  double boot_uptime_s_;  // own clock when it booted
  Duration clock_jump_{0};
  FlightState state_;
  Eigen::Vector3d hold_{0, 0, 0};  // where it hovers in all modes but those that land
  std::uint32_t custom_mode_ = 0;
  bool is_armed_ = false;
  bool pilot_flies_ = true;  // the script, not the link
  bool has_gcs_ = false;     // a ground station's heartbeat has come
  bool nan_attitude_ = false;
  std::uint8_t peer_system_ = 0;  // of the message that is handled
  std::uint8_t peer_component_ = 0;
  std::optional<Time> landing_since_;
  SitlResult result_;
};

}  // namespace kestrel
