// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/guidance_permission.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/global_position.h"

namespace kestrel {
namespace {

// Names of the autopilot's limits: horizontal speed, climb, descent (m/s), tilt (deg).
struct LimitNames {
  std::string_view speed, climb, sink, tilt;
};
constexpr LimitNames kArduPilotLimits{"WP_SPD", "WP_SPD_UP", "WP_SPD_DN", "ATC_ANGLE_MAX"};
constexpr LimitNames kPx4Limits{"MPC_XY_VEL_MAX", "MPC_Z_VEL_MAX_UP", "MPC_Z_VEL_MAX_DN",
                                "MPC_TILTMAX_AIR"};
// Shaping of ArduPilot's velocities: jerk (m/s^3), vertical acceleration and jerk; and the time for
// which it flies on without set-points (s).
constexpr std::string_view kArduPilotJerk = "PSC_JERK_NE", kArduPilotBraking = "WP_ACC_Z",
                           kArduPilotVerticalJerk = "PSC_JERK_D",
                           kArduPilotTimeout = "GUID_TIMEOUT";
constexpr double kSlowestJerk = 1;     // below it no flight is possible
constexpr double kMaxTimeout_s = 0.5;  // a UAV at 5 m/s flies on by 2.5 m before it brakes
// PX4's actions when set-points stop: without a transmitter, and with its pilot ignored.
constexpr std::string_view kPx4LossAction = "COM_OBL_RC_ACT", kPx4RadioLossAction = "NAV_RCL_ACT";
constexpr std::string_view kPx4Timeout = "COM_OF_LOSS_T";
constexpr double kMaxPx4Timeout_s = 1;  // it is on its way to rest already
constexpr std::string_view kPx4PositionGain = "MPC_XY_P", kPx4HeightGain = "MPC_Z_P";
constexpr std::string_view kPx4VelocityP = "MPC_XY_VEL_P_ACC", kPx4VelocityI = "MPC_XY_VEL_I_ACC",
                           kPx4VelocityD = "MPC_XY_VEL_D_ACC";
constexpr std::string_view kArduPilotPlaceP = "PSC_NE_POS_P", kArduPilotVelocityP = "PSC_NE_VEL_P",
                           kArduPilotVelocityI = "PSC_NE_VEL_I",
                           kArduPilotVelocityD = "PSC_NE_VEL_D";

const LimitNames& NamesFor(AutopilotKind kind) {
  return kind == AutopilotKind::kPx4 ? kPx4Limits : kArduPilotLimits;
}

}  // namespace

void WantGuidanceParameters(Autopilot* autopilot) {
  ParameterReader& parameters = autopilot->parameters();
  const LimitNames& names = NamesFor(autopilot->kind());
  for (const std::string_view name : {names.speed, names.climb, names.sink, names.tilt}) {
    parameters.Want(name);
  }
  const bool is_px4 = autopilot->kind() == AutopilotKind::kPx4;
  const std::array<std::string_view, 8> px4 = {kPx4LossAction,   kPx4RadioLossAction, kPx4Timeout,
                                               kPx4PositionGain, kPx4HeightGain,      kPx4VelocityP,
                                               kPx4VelocityI,    kPx4VelocityD};
  const std::array<std::string_view, 8> ardupilot = {
      kArduPilotJerk,   kArduPilotBraking,   kArduPilotVerticalJerk, kArduPilotTimeout,
      kArduPilotPlaceP, kArduPilotVelocityP, kArduPilotVelocityI,    kArduPilotVelocityD};
  for (const std::string_view name : is_px4 ? std::span<const std::string_view>(px4)
                                            : std::span<const std::string_view>(ardupilot)) {
    parameters.Want(name);
  }
}

AutopilotLimits LimitsOf(const Autopilot& autopilot) {
  const LimitNames& names = NamesFor(autopilot.kind());
  const ParameterReader& parameters = autopilot.parameters();
  return {parameters.Find(names.speed), parameters.Find(names.climb), parameters.Find(names.sink),
          parameters.Find(names.tilt)};
}

GuidanceOptions OptionsFor(const Autopilot& autopilot, GuidanceOptions options,
                           bool is_in_its_frame) {
  const bool is_px4 = autopilot.kind() == AutopilotKind::kPx4;
  options.stream_before_start = options.stream_before_start || is_px4;
  // PX4's LAND would brake on a moving deck.
  options.land_in_contact = options.land_in_contact || !is_px4;
  // A value beyond what guidance counts on is as good as the last that it counts on.
  const auto read = [&](std::string_view name, double least, double most, double* value) {
    const auto found = autopilot.parameters().Find(name);
    if (found) *value = std::clamp(*found, least, most);
  };
  if (options.autopilot_jerk == 0)
    read(kArduPilotJerk, kSlowestJerk, 1000, &options.autopilot_jerk);
  StaleOptions& stale = options.stale;
  if (is_px4) {
    VelocityControl& control = options.model.control;
    read(kPx4VelocityP, 0, 20, &control.p);
    read(kPx4VelocityI, 0, 20, &control.i);
    read(kPx4VelocityD, 0, 0.9, &control.d);
  }
  if (!is_px4) {
    PathControl& path = options.model.path;
    read(kArduPilotPlaceP, 0, 20, &path.place);
    read(kArduPilotVelocityP, 0, 20, &path.p);
    read(kArduPilotVelocityI, 0, 20, &path.i);
    read(kArduPilotVelocityD, 0, 5, &path.d);
    read(kArduPilotTimeout, 0.1, 60, &stale.timeout_s);
    read(kArduPilotBraking, 0.1, 20, &stale.vertical_braking);
    read(kArduPilotVerticalJerk, 0.1, 1000, &stale.vertical_jerk);
  } else if (is_in_its_frame) {
    read(kPx4PositionGain, 0, 2, &stale.position_gain);
    read(kPx4HeightGain, 0, 2, &stale.height_gain);
  } else {
    read(kPx4Timeout, 0, 60, &stale.timeout_s);
  }
  return options;
}

std::optional<Eigen::Vector3d> HomeOf(const Autopilot& autopilot) {
  if (!autopilot.home() || !autopilot.origin()) return std::nullopt;
  return LocalFromGlobal(autopilot.kind(), *autopilot.origin(), *autopilot.home());
}

std::optional<double> GroundUnderHome(const Autopilot& autopilot, double leg_m) {
  const auto home = HomeOf(autopilot);
  if (!home) return std::nullopt;
  return home->z() - leg_m;
}

std::string WhyNotFly(const Autopilot& autopilot, bool has_position) {
  if (autopilot.kind() != AutopilotKind::kArduPilot && autopilot.kind() != AutopilotKind::kPx4) {
    return "the autopilot is neither ArduPilot nor PX4";
  }
  if (!autopilot.is_multicopter()) {
    return fmt::format("the vehicle is {}, expected a multicopter",
                       VehicleName(autopilot.vehicle_type()));
  }
  if (!autopilot.is_in_failsafe()) return "";
  const std::string failsafe = FailsafeInWords(autopilot.kind(), autopilot.custom_mode());
  if (autopilot.kind() == AutopilotKind::kPx4) {
    return fmt::format("{}: give another mode, e.g. {}, then OFFBOARD", failsafe,
                       has_position ? "Hold" : "Altitude");
  }
  return fmt::format("{}: see to its cause, then give {} again", failsafe,
                     has_position ? "GUIDED" : "GUIDED_NOGPS");
}

std::string WhyNotGuide(const Autopilot& autopilot, const GuidanceOptions& options,
                        const Eigen::Vector3d& position, Time now, bool is_position_by_pad) {
  const FlightLimitsOptions& limits = options.limits;
  if (std::string why = WhyNotFly(autopilot, /*has_position=*/true); !why.empty()) return why;
  if (!autopilot.is_position_good(now).value_or(true)) {
    return "the autopilot has no good estimate of its position";
  }
  auto home = HomeOf(autopilot);
  // PX4 has none without a global position.
  if (!home && is_position_by_pad && autopilot.kind() == AutopilotKind::kPx4) home = position;
  if (!home) return "the autopilot has no home position";
  if (!autopilot.parameters().is_done()) return "the autopilot's limits are not read yet";
  if (const std::vector<std::string> beyond = ViolationsOf(LimitsOf(autopilot), limits);
      !beyond.empty()) {
    return fmt::format("{}", fmt::join(beyond, "; "));
  }
  if (const std::string unsafe = UnsafeLoss(autopilot, is_position_by_pad);
      !unsafe.empty() && !options.accept_unsafe_loss) {
    return unsafe +
           " (`kestrel doctor --fix` sets it; --set fly.guidance.accept_unsafe_loss=true flies so)";
  }
  return FlightLimits(limits, home->head<2>()).WhyNot(position);
}

std::string UnsafeLoss(const Autopilot& autopilot, bool is_position_by_pad) {
  const ParameterReader& parameters = autopilot.parameters();
  const auto value = [&](std::string_view name) { return parameters.Find(name).value_or(0); };
  if (autopilot.kind() == AutopilotKind::kArduPilot) {
    const double timeout_s = value(kArduPilotTimeout);
    if (timeout_s <= kMaxTimeout_s) return "";
    return fmt::format(
        "GUID_TIMEOUT is {:g} s, expected at most {:g}: without this computer ArduPilot flies on "
        "for so long, down as well",
        timeout_s, kMaxTimeout_s);
  }
  if (const double timeout_s = value(kPx4Timeout); timeout_s > kMaxPx4Timeout_s) {
    return fmt::format("COM_OF_LOSS_T is {:g} s, expected at most {:g}", timeout_s,
                       kMaxPx4Timeout_s);
  }
  const int action = static_cast<int>(value(kPx4LossAction));
  const int without_radio = static_cast<int>(value(kPx4RadioLossAction));
  constexpr int kPosition = 0, kReturn = 3, kLand = 4, kHold = 5;  // COM_OBL_RC_ACT
  constexpr int kRadioHold = 1, kRadioReturn = 2;                  // NAV_RCL_ACT
  if (is_position_by_pad) {
    if (action == kLand || action == kHold) return "";  // Hold ends in a landing
    return fmt::format(
        "COM_OBL_RC_ACT is {}, expected 4 (Land): without this computer PX4 soon has no position",
        action);
  }
  if (action == kHold || action == kReturn) return "";
  const bool holds_without_radio = without_radio == kRadioHold || without_radio == kRadioReturn;
  if (action == kPosition && holds_without_radio) return "";
  return fmt::format(
      "COM_OBL_RC_ACT is {} with NAV_RCL_ACT {}: without this computer PX4 {}; expected "
      "COM_OBL_RC_ACT 5 (Hold)",
      action, without_radio,
      action == kPosition ? "flies on for ever if there is no transmitter" : "does not hold");
}

}  // namespace kestrel
