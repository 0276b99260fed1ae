// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"
#include "kestrel/simulation/autopilot_rules/landing_rules.h"
#include "kestrel/simulation/autopilot_rules/px4_time_sync.h"
#include "kestrel/simulation/autopilots/attitude_error.h"
#include "kestrel/simulation/autopilots/autopilot_messages.h"
#include "kestrel/simulation/autopilots/autopilot_model_options.h"
#include "kestrel/simulation/autopilots/external_navigation.h"
#include "kestrel/simulation/autopilots/guided_rules.h"
#include "kestrel/simulation/autopilots/land_detector.h"
#include "kestrel/simulation/autopilots/message_streams.h"
#include "kestrel/simulation/autopilots/return_flight.h"
#include "kestrel/simulation/autopilots/simulated_mount.h"
#include "kestrel/simulation/autopilots/simulated_pilot.h"
#include "kestrel/simulation/autopilots/simulated_uav.h"
#include "kestrel/simulation/autopilots/sitl_result.h"
#include "kestrel/simulation/autopilots/stopping_path.h"
#include "kestrel/simulation/autopilots/vehicle_world.h"
#include "kestrel/simulation/vehicle/navigation_model.h"

namespace kestrel {

// A UAV with its autopilot, as a companion computer sees it: clock, messages, modes, parameters,
// and its flight and landing by the messages it receives. It steps on any clock; no thread, no
// socket.
class AutopilotModel {
 public:
  using Send = std::function<void(const AutopilotMessage& message)>;

  // The world must outlive this. Throws InputError when the options are not valid, or name a
  // parameter that does not exist.
  AutopilotModel(AutopilotFirmware firmware, const AutopilotModelOptions& options,
                 VehicleWorld* world, Time start, std::uint64_t seed, Send send);

  // Continues to 'now' on the local clock, in steps of 4 ms.
  void Step(Time now);

  // A message from 'system', 'component' arrived at 'now'.
  void Handle(const CompanionMessage& message, std::uint8_t system, std::uint8_t component,
              Time now);

  // Injected faults.
  void Reboot(Time now);            // except the flight: clock and streams restart, and it is
                                    // silent for a while
  void JumpClock(Duration change);  // shifts the autopilot's own clock
  void set_nan_attitude(bool nan) { nan_attitude_ = nan; }

  // Time of its own clock, ns since boot.
  std::int64_t OwnTime(Time now) const;

  const PoseSample& truth() const { return uav_.pose(); }  // at the last step
  // Attitude of its gimbal in the world; level and ahead where it has none.
  Eigen::Quaterniond world_from_platform() const {
    return mount_ ? mount_->world_from_platform() : Eigen::Quaterniond::Identity();
  }
  std::uint32_t custom_mode() const { return custom_mode_; }
  bool is_armed() const { return is_armed_; }
  const SitlResult& result() const { return result_; }
  AutopilotParameters& parameters() { return parameters_; }

 private:
  // The source of a wish for a mode.
  enum class Wish { kPilot, kLink, kFailsafe, kResumption };

  // autopilot_model.cc: flight.
  void StepOnce(Time now);
  void ObserveFlight(Time now);
  void DriftAtRest();
  FlightCommand Fly();
  SetPoint Stop();
  SetPoint Hold() const;
  FlightCommand FlyLevel() const;
  void FollowPilot(Time now);
  void WatchSetPoints(Time now);
  void EnterBatteryFailsafe(Time now);
  bool EnterMode(std::uint32_t custom_mode, Wish wish, Time now);
  void EnterMode(FlightMode mode, Wish wish, Time now) {
    EnterMode(CustomModeOf(kind(), mode), wish, now);
  }
  void LeaveMode(Time now);
  bool IsIn(FlightMode mode) const { return custom_mode_ == CustomModeOf(kind(), mode); }
  // Flies by set-points.
  bool IsGuided() const { return IsIn(FlightMode::kGuided) || IsIn(FlightMode::kGuidedByLean); }
  // The rules for them, in this mode.
  GuidedRules& Guided() const {
    return !is_px4() && IsIn(FlightMode::kGuidedByLean) ? *guided_by_lean_ : *guided_;
  }
  bool LandsByTarget() const { return IsIn(FlightMode::kPrecisionLand); }
  bool MayComeDown() const;
  void ObserveContact(Time now);
  void DisarmAfterLanding(Time now);
  bool is_px4() const { return firmware_ == AutopilotFirmware::kPx4; }
  AutopilotKind kind() const { return is_px4() ? AutopilotKind::kPx4 : AutopilotKind::kArduPilot; }
  std::int64_t OwnMicroseconds(Time now) const { return OwnTime(now) / 1000; }
  bool IsSilentAfterReboot(Time now) const;
  // True within 'for_s' from 'after_s' after the start; false for a negative 'after_s'.
  bool IsWithin(Time now, double after_s, double for_s) const;
  bool HasPosition(Time now) const;
  // Without GNSS and flow, and without ODOMETRY of late.
  bool LacksPosition() const { return external_ && !HasPosition(state_.time); }
  bool NeedsPosition(std::uint32_t custom_mode) const;
  bool Descends() const;
  std::uint32_t ReportedMode() const { return Descends() ? kPx4Descend : custom_mode_; }
  void UseExternalNavigation();
  void MistakeAttitude(Time now);
  void MeasureAcceleration();

  // autopilot_reports.cc: sent messages.
  bool SendMessage(std::uint32_t id, Time now);
  bool SendPose(std::uint32_t id, Time now);
  double HeightAboveGround(Time now) const;
  Eigen::Vector3d Vibration();
  bool SendPlace(std::uint32_t id, Time now);
  bool SendMount(std::uint32_t id) const;
  bool SendView(std::uint32_t id, Time now) const;
  void SendText(Severity severity, const std::string& text) const;
  std::uint8_t LandedState() const;
  mavlink::Heartbeat HeartbeatOf() const;
  mavlink::AutopilotVersion VersionOf() const;

  // autopilot_commands.cc: received messages.
  void Receive(const mavlink::Heartbeat& message, Time now);
  void Receive(const mavlink::CommandLong& message, Time now);
  void Receive(const mavlink::SetMode& message, Time now);
  void Receive(const mavlink::Timesync& message, Time now);
  void Receive(const mavlink::LandingTarget& message, Time now);
  void Receive(const mavlink::TargetRelative& message, Time now);
  void Receive(const mavlink::SetAttitudeTarget& message, Time now);
  void Receive(const mavlink::SetPositionTargetLocalNed& message, Time now);
  template <class Message>
  void ReceiveSetPoint(const Message& message, Time now);
  void Receive(const mavlink::ParamRequestRead& message, Time now);
  void Receive(const mavlink::ParamRequestList& message, Time now);
  void Receive(const mavlink::ParamSet& message, Time now);
  void Receive(const mavlink::GimbalManagerSetPitchyaw& message, Time now);
  void Receive(const mavlink::SetGpsGlobalOrigin& message, Time now);
  void Receive(const mavlink::Odometry& message, Time now);
  bool IsForIt(std::uint8_t target_system) const;
  std::uint8_t Execute(const mavlink::CommandLong& command, Time now);
  std::uint8_t SetModeBy(const mavlink::CommandLong& command, Time now);
  std::uint8_t Arm(bool arm, bool by_force);
  std::uint8_t OperateGripper(float motion);
  std::uint8_t TakeOff(double altitude, Time now);

  AutopilotFirmware firmware_;
  AutopilotModelOptions options_;
  VehicleWorld& world_;
  Send send_;
  Random random_;
  Random shakes_;  // of the accelerometer
  AutopilotParameters parameters_;
  SimulatedUav uav_;
  NavigationSensor navigation_;
  SimulatedPilot pilot_;
  Px4TimeSync px4_clock_;
  std::unique_ptr<LandingRules> landing_;
  std::unique_ptr<GuidedRules> guided_;
  std::unique_ptr<GuidedRules> guided_by_lean_;  // of ArduPilot
  LandDetector detector_;
  ReturnFlight return_;
  MessageStreams streams_;
  Eigen::Vector3d velocity_{0, 0, 0};           // true one at the last step
  Eigen::Vector3d acceleration_{0, 0, 0};       // measured, FLU, m/s^2
  std::optional<ExternalNavigation> external_;  // nothing: it has GNSS
  AttitudeError attitude_error_;                // without GNSS
  std::optional<SimulatedMount> mount_;         // nothing: it has no gimbal

  Time start_;
  Time stepped_to_;
  Time booted_at_;
  double boot_uptime_s_;  // own clock when it booted
  Duration clock_jump_{0};
  FlightState state_;
  bool has_jumped_ = false;        // the estimated position has jumped
  double rest_drift_m_ = 0;        // drift of the estimated height while it stands
  Eigen::Vector3d hold_{0, 0, 0};  // place where it hovers unless something else moves it
  StoppingPath stopping_;          // path of the mode that holds, from the last change of mode
  std::uint32_t custom_mode_ = 0;
  bool is_armed_ = false;
  bool pilot_flies_ = true;      // the script flies, not the link
  bool is_taking_off_ = false;   // in the guided mode
  bool resumes_guided_ = false;  // its own failsafe ended the mode: it returns to it
  bool is_in_failsafe_ = false;
  bool has_origin_ = true;
  bool has_gcs_ = false;  // a ground station's heartbeat has come
  bool nan_attitude_ = false;
  std::uint8_t peer_system_ = 0;  // sender of the message being handled
  std::uint8_t peer_component_ = 0;
  std::optional<Time> landing_since_;
  SitlResult result_;
};

}  // namespace kestrel
