// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"
#include "kestrel/simulation/vehicle/gimbal_model.h"

namespace kestrel {

// A gimbal behind a simulated autopilot. Times are from the start of the simulation; negative:
// never.
struct SimulatedMountOptions : GimbalMotorOptions {
  double reports_hz = 20;
  double pitch_min_deg = -120;
  double pitch_max_deg = 30;
  double yaw_max_deg = 180;
  bool echoes = false;
  double stick_after_s = -1;
  double other_after_s = -1;

  static void Visit(auto& self, auto&& visit) {
    GimbalMotorOptions::Visit(self, visit);
    visit("reports_hz", self.reports_hz, Range{0.5, 200},
          "reports per second of the gimbal to the autopilot, which repeats the newest one");
    visit("pitch_min_deg", self.pitch_min_deg, Range{-180, 0}, "lowest pitch; -90 is down");
    visit("pitch_max_deg", self.pitch_max_deg, Range{0, 90}, "highest pitch");
    visit("yaw_max_deg", self.yaw_max_deg, Range{0, 180},
          "largest yaw off the vehicle's heading, to both sides");
    visit("echoes", self.echoes, "the reported attitude is the set-point, as by PX4's AUX output");
    visit("stick_after_s", self.stick_after_s, Range{-1, 10000},
          "time at which the pilot moves the gimbal by stick for 2 s; negative: never");
    visit("other_after_s", self.other_after_s, Range{-1, 10000},
          "time at which a ground station takes control of the gimbal; negative: never");
  }
};

// A sender on the link.
struct LinkId {
  std::uint8_t system = 0;
  std::uint8_t component = 0;

  bool operator==(const LinkId&) const = default;
};

// A gimbal and its manager (MAVLink's gimbal protocol v2) as an autopilot has them. ArduPilot obeys
// whoever sends last, and drops set-points of angles and rates together; its reports are against
// the vehicle's heading. PX4 obeys only who has primary control; its reports are against north. In
// both the stick takes the gimbal.
class SimulatedMount {
 public:
  SimulatedMount(AutopilotFirmware firmware, const SimulatedMountOptions& options,
                 std::uint8_t system, Time start, Random random);

  // Continues to 'now'.
  void Step(Time now, const RigidTransform& world_from_body);

  // Carries out a command of the gimbal protocol; returns MAV_RESULT.
  std::uint8_t Execute(const mavlink::CommandLong& command, const LinkId& sender, Time now);
  void Handle(const mavlink::GimbalManagerSetPitchyaw& message, const LinkId& sender, Time now);

  mavlink::GimbalDeviceAttitudeStatus AttitudeMessage(std::uint32_t boot_ms) const;
  mavlink::GimbalManagerStatus StatusMessage(std::uint32_t boot_ms) const;
  mavlink::GimbalManagerInformation InformationMessage(std::uint32_t boot_ms) const;
  // The channels of the pilot's transmitter: the stick of the gimbal's pitch is on the seventh.
  mavlink::RcChannels ChannelsMessage(std::uint32_t boot_ms) const;

  // The true attitude.
  Eigen::Quaterniond world_from_platform() const { return angles_.rotation(); }

 private:
  // The command to the motors: angles, or rates. The yaw of angles is against the world's x axis,
  // or the vehicle's heading.
  struct SetPoint {
    GimbalAngles value;
    bool is_rate = false;
    bool is_in_earth = false;
  };
  // Parameters of a set-point on the link: rad and rad/s, pitch up, yaw to the right.
  struct PitchYaw {
    double pitch, yaw, pitch_rate, yaw_rate;
    std::uint32_t flags;
  };

  bool is_px4() const { return firmware_ == AutopilotFirmware::kPx4; }
  bool IsDue(double after_s, Time now) const;
  void FollowScript(Time now);
  void Obey(const PitchYaw& wanted, Time now);
  GimbalAngles Aim(double seconds, double heading);
  GimbalAngles WithinRange(GimbalAngles aim, double heading) const;

  AutopilotFirmware firmware_;
  SimulatedMountOptions options_;
  std::uint8_t system_;
  Time start_;
  Random random_;
  Time stepped_to_;
  Time report_due_;
  Time commanded_;
  LinkId primary_;
  SetPoint set_point_;  // level and ahead
  bool has_begun_ = false;
  bool is_stick_moved_ = false;
  bool has_other_taken_ = false;
  GimbalAngles aim_, angles_;                                     // in the world
  Eigen::Quaterniond reported_ = Eigen::Quaterniond::Identity();  // in the frame of the reports
};

}  // namespace kestrel
