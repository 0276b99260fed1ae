// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/guidance_permission.h"

#include <algorithm>
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
constexpr std::string_view kArduPilotJerk = "PSC_JERK_NE";  // m/s^3
constexpr double kSlowestJerk = 1;                          // below it no flight is possible
// PX4's actions when set-points stop: without a transmitter, and with its pilot ignored.
constexpr std::string_view kPx4LossAction = "COM_OBL_RC_ACT", kPx4RadioLossAction = "NAV_RCL_ACT";

const LimitNames& NamesFor(AutopilotKind kind) {
  return kind == AutopilotKind::kPx4 ? kPx4Limits : kArduPilotLimits;
}

}  // namespace

void WantGuidanceParameters(Autopilot* autopilot) {
  const LimitNames& names = NamesFor(autopilot->kind());
  for (const std::string_view name : {names.speed, names.climb, names.sink, names.tilt}) {
    autopilot->parameters().Want(name);
  }
  if (autopilot->kind() != AutopilotKind::kPx4) {
    autopilot->parameters().Want(kArduPilotJerk);
    return;
  }
  autopilot->parameters().Want(kPx4LossAction);
  autopilot->parameters().Want(kPx4RadioLossAction);
}

AutopilotLimits LimitsOf(const Autopilot& autopilot) {
  const LimitNames& names = NamesFor(autopilot.kind());
  const ParameterReader& parameters = autopilot.parameters();
  return {parameters.Find(names.speed), parameters.Find(names.climb), parameters.Find(names.sink),
          parameters.Find(names.tilt)};
}

GuidanceOptions OptionsFor(const Autopilot& autopilot, GuidanceOptions options) {
  const bool is_px4 = autopilot.kind() == AutopilotKind::kPx4;
  options.stream_before_start = options.stream_before_start || is_px4;
  // PX4's LAND would brake on a moving deck.
  options.land_in_contact = options.land_in_contact || !is_px4;
  if (const auto jerk = autopilot.parameters().Find(kArduPilotJerk);
      jerk && options.autopilot_jerk == 0) {
    options.autopilot_jerk = std::max(*jerk, kSlowestJerk);
  }
  return options;
}

std::optional<Eigen::Vector2d> HomeOf(const Autopilot& autopilot) {
  if (!autopilot.home() || !autopilot.origin()) return std::nullopt;
  return LocalFromGlobal(autopilot.kind(), *autopilot.origin(), *autopilot.home()).head<2>();
}

std::string WhyNotGuide(const Autopilot& autopilot, const FlightLimitsOptions& limits,
                        const Eigen::Vector3d& position, Time now) {
  if (autopilot.kind() != AutopilotKind::kArduPilot && autopilot.kind() != AutopilotKind::kPx4) {
    return "the autopilot is neither ArduPilot nor PX4";
  }
  if (!autopilot.is_multicopter()) {
    return fmt::format("the vehicle is {}, expected a multicopter",
                       VehicleName(autopilot.vehicle_type()));
  }
  if (autopilot.is_in_failsafe()) {
    return FailsafeInWords(autopilot.kind(), autopilot.custom_mode());
  }
  if (!autopilot.is_position_good(now).value_or(true)) {
    return "the autopilot has no good estimate of its position";
  }
  const auto home = HomeOf(autopilot);
  if (!home) return "the autopilot has no home position";
  if (!autopilot.parameters().is_done()) return "the autopilot's limits are not read yet";
  if (const std::vector<std::string> beyond = ViolationsOf(LimitsOf(autopilot), limits);
      !beyond.empty()) {
    return fmt::format("{}", fmt::join(beyond, "; "));
  }
  return FlightLimits(limits, *home).WhyNot(position);
}

std::string DangerOfGuidance(const Autopilot& autopilot) {
  const ParameterReader& parameters = autopilot.parameters();
  if (autopilot.kind() != AutopilotKind::kPx4 || parameters.Find(kPx4LossAction) != 0 ||
      parameters.Find(kPx4RadioLossAction) != 0) {
    return "";
  }
  return "COM_OBL_RC_ACT 0 with NAV_RCL_ACT 0: should this computer fail, PX4 flies on with the "
         "last velocity for ever; set COM_OBL_RC_ACT to 5 (Hold)";
}

}  // namespace kestrel
