// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/parameter_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "kestrel/flight/doctor/link_checks.h"
#include "kestrel/flight/doctor/no_position_checks.h"
#include "kestrel/flight/doctor/pad_position_checks.h"
#include "kestrel/flight/doctor/parameter_rules.h"
#include "kestrel/flight/doctor/statistics.h"

namespace kestrel {
namespace {

constexpr std::array<ListedCheck, 38> kOfArduPilot = {{
    {"PLND_ENABLED", "1"},
    {"PLND_TYPE", "1, targets by MAVLink"},
    {"PLND_ORIENT", "25, down"},
    {"PLND_YAW_ALIGN", "0"},
    {"PLND_LAND_OFS_X", "0: else it lands so many centimetres beside the centre"},
    {"PLND_LAND_OFS_Y", "0: else it lands so many centimetres beside the centre"},
    {"PLND_LAG", "the measured latency (check latency)"},
    {"RNGFND1_TYPE", "10, with fly.messages.sends_distance"},
    {"EK3_SRC1_POSZ", "not 2: the range finder jumps over the deck"},
    {"EK3_SRC1_VELXY", "not 5: the speed by optical flow is the deck's"},
    {"MAV_GCS_SYSID", "left to the ground station"},
    {"MAV_OPTIONS", "with bit 0 Kestrel has to send with the autopilot's own system"},
    {"PLND_EST_TYPE", "--moving: 1"},
    {"PLND_OPTIONS", "--moving: bit 0"},
    {"PLND_XY_DIST_MAX", "--moving: 0 or at least 5"},
    {"PLND_STRICT", "--moving: 0"},
    {"PLND_RET_MAX", "--moving: 0"},
    {"WP_SPD", "--moving, --guide: faster than the target"},
    {"ATC_ANGLE_MAX", "--moving: at least 20 deg; --guide: fly.guidance.limits.max_tilt_deg"},
    {"GUID_TIMEOUT", "--guide: 0.1 to 0.3 s: so long the last set-point is flown on"},
    {"FS_GCS_ENABLE", "--guide: not 5, which lands on the spot"},
    {"WP_ACC", "--guide --moving: at least 4 m/s^2"},
    {"PSC_JERK_NE", "--guide --moving: at least 12 m/s^3"},
    {"VISO_TYPE", "--pad-position: 1, ODOMETRY is used"},
    {"VISO_DELAY_MS", "--pad-position: the measured latency"},
    {"EK3_SRC1_POSXY", "--pad-position: 6, external navigation"},
    {"EK3_SRC1_VELZ", "--pad-position: 0 or 6, as EK3_SRC1_VELXY and _POSZ not by GNSS"},
    {"EK3_SRC1_YAW", "--pad-position: 1, or 6 where the compass is disturbed"},
    {"GPS1_TYPE", "--pad-position: 0"},
    {"FS_EKF_ACTION", "--pad-position: 1, land; --no-position: not 3, which always lands"},
    {"FS_THR_ENABLE", "--pad-position: 3, land, 7 or 0; a return climbs"},
    {"FENCE_ENABLE", "--pad-position, --no-position: 0, else it arms with a position only"},
    {"GUID_OPTIONS",
     "--no-position, --floor: without bit 3, which takes a climb rate for a thrust"},
    {"MOT_THST_HOVER", "--no-position: learnt, not 0.35 as it comes"},
    {"MNT1_TYPE", "with a gimbal: its type; 1, servos, reports the set-point"},
    {"MNT1_DEFLT_MODE", "with a gimbal: not 0, retracted"},
    {"CAM1_TYPE", "with a zoom that is not heard: its type; --follow: 0"},
    {"CAM1_HFOV", "with a zoom: 0: else this is reported, whatever the lens does"},
}};

constexpr std::array<ListedCheck, 31> kOfPx4 = {{
    {"VTE_EN", "1 with the profile px4-vte, else 0; not with --guide"},
    {"VTE_AID_MASK", "bit 1, with the profile px4-vte"},
    {"LTEST_MODE", "--moving: 0"},
    {"RTL_PLD_MD", "not 2: each return, that of a failsafe too, searches for the pattern"},
    {"PLD_MAX_SRCH", "at least 1: else it lands without a pattern that is lost once"},
    {"PLD_SRCH_ALT", "so low that the camera sees the pattern: it climbs there when it is lost"},
    {"MPC_LAND_SPEED", "at most MPC_Z_VEL_MAX_DN"},
    {"MPC_Z_VEL_MAX_DN", "at least MPC_LAND_SPEED: else contact is not detected"},
    {"COM_DISARM_LAND", "above 0: else the motors run on"},
    {"EKF2_HGT_REF", "not 2: the height by range finder follows the deck"},
    {"EKF2_RNG_CTRL", "--moving: below 2"},
    {"EKF2_OF_CTRL", "--moving: 0"},
    {"COM_OF_LOSS_T", "--guide: 0.1 to 0.5 s: so long the last set-point is flown on"},
    {"COM_OBL_RC_ACT", "--guide: 5, Hold; with --pad-position or --no-position 4, Land"},
    {"NAV_RCL_ACT", "--guide: not 0 where COM_OBL_RC_ACT is 0 to 2; --pad-position: not 2"},
    {"EKF2_EV_CTRL", "--pad-position: 11, place, height and heading; at least bit 0"},
    {"EKF2_NOAID_TOUT", "--pad-position: at most 1 s: so long it flies by a guess"},
    {"EKF2_GPS_CTRL", "--pad-position: 0"},
    {"SYS_HAS_GPS", "--pad-position, --no-position: 0, there is no GNSS"},
    {"COM_ARM_WO_GPS", "--no-position: 1 or 2, it arms without a position"},
    {"MPC_USE_HTE", "--no-position: 1, the hover thrust is learnt"},
    {"COM_RC_OVERRIDE", "--guide: bit 1, the sticks end OFFBOARD"},
    {"MAN_OVERRIDE_SPD", "--guide: 0 or more, the sticks end OFFBOARD"},
    {"LNDMC_XY_VEL_MAX", "--guide: above the target's speed, else it does not disarm"},
    {"MPC_XY_VEL_MAX", "--guide: above the target's speed"},
    {"MPC_TILTMAX_AIR", "--guide: at least fly.guidance.limits.max_tilt_deg"},
    {"MNT_MODE_IN", "with a gimbal: 0 or 4, MAVLink's gimbal protocol v2"},
    {"MNT_MODE_OUT", "with a gimbal: 2; 0, servos, reports the set-point"},
    {"MAV_0_FORWARD", "with a gimbal that is not heard: 1"},
    {"MAV_1_FORWARD", "with a gimbal that is not heard: 1"},
    {"MAV_2_FORWARD", "with a gimbal that is not heard: 1"},
}};

// Checks the autopilot's largest lean. Guidance refuses where it may lean more by its own limits
// than the autopilot allows.
void CheckTilt(std::string_view name, ParameterRules* rules) {
  constexpr double kLeast_deg = 20;
  constexpr double kUsual_deg = 30;
  const DoctorUse& use = rules->all().use;
  if (use.guides) {
    const std::string why = fmt::format(
        "guidance may lean by {:g} deg (fly.guidance.limits.max_tilt_deg), and refuses "
        "where the autopilot does not",
        use.tilt_deg);
    rules->WantAtLeast(name, Verdict::kWrong, use.tilt_deg, {use.tilt_deg, why});
    return;
  }
  rules->WantAtLeast(name, Verdict::kDoubtful, kLeast_deg,
                     {kUsual_deg, "too little tilt to follow in wind"});
}

// --- ArduPilot ---

void CheckPrecisionLandingOfArduPilot(ParameterRules* rules) {
  if (rules->Find("PLND_ENABLED").value_or(0) == 0 && !rules->Find("PLND_TYPE")) {
    // ArduPilot hides the other parameters until then.
    rules->WantExactly("PLND_ENABLED", rules->without_targets(),
                       {1,
                        "precision landing is off, and its parameters hidden until it is on "
                        "and the autopilot restarted",
                        true});
    return;
  }
  rules->WantExactly("PLND_ENABLED", rules->without_targets(), {1, "targets are ignored", true});
  rules->WantExactly("PLND_TYPE", rules->without_targets(),
                     {1, "targets by MAVLink are ignored", true});
  constexpr double kDown = 25;
  rules->WantExactly("PLND_ORIENT", rules->without_targets(),
                     {kDown, "targets are taken for ones in another direction", true});
  rules->WantExactly("PLND_YAW_ALIGN", rules->without_targets(),
                     {0, "Kestrel's targets are turned by it: it lands beside or flies away"});
  for (const std::string_view name : {"PLND_LAND_OFS_X", "PLND_LAND_OFS_Y"}) {
    rules->WantExactly(name, Verdict::kDoubtful,
                       {0,
                        "it lands so many centimetres beside the pattern's centre; left over "
                        "from another camera?"});
  }
  constexpr int kSupportedDistance = 10;
  if (rules->all().use.sends_distance) {
    rules->WantExactly("RNGFND1_TYPE", rules->without_targets(),
                       {kSupportedDistance, "distances by MAVLink are ignored", true});
  }
}

void CheckMovingTargetOfArduPilot(ParameterRules* rules) {
  constexpr double kFarEnough_m = 5;
  rules->WantExactly("PLND_EST_TYPE", rules->without_targets(),
                     {1, "the raw estimate lags a target that moves and never lands on it"});
  rules->WantBit("PLND_OPTIONS", rules->without_targets(), 0,
                 "without bit 0 the target is thought to stand: it trails by metres");
  rules->Want("PLND_XY_DIST_MAX", rules->without_targets(),
              {0, "it does not descend while it is further off than this"},
              [](double metres) { return metres == 0 || metres >= kFarEnough_m; });
  rules->WantExactly("PLND_STRICT", Verdict::kDoubtful,
                     {0, "when the target is lost it flies to where it was"});
  rules->WantExactly("PLND_RET_MAX", rules->without_targets(),
                     {0, "retries go back to a place where the target no longer is"});
}

void CheckSpeedsOfArduPilot(ParameterRules* rules) {
  const double speed_mps = std::ceil(rules->wanted_mps());
  rules->WantAtLeast("WP_SPD", Verdict::kWrong, rules->target_mps() + 1,
                     {speed_mps, "slower than the target and a margin: it falls behind"});
  CheckTilt("ATC_ANGLE_MAX", rules);
}

void CheckEstimatorOfArduPilot(ParameterRules* rules) {
  if (rules->all().use.pad_position) return CheckPadPositionOfArduPilot(rules);
  constexpr double kRangeFinder = 2;
  constexpr double kOpticalFlow = 5;
  const Verdict otherwise = rules->moves() ? Verdict::kWrong : Verdict::kDoubtful;
  rules->Want("EK3_SRC1_POSZ", otherwise, {1, "height by range finder jumps over the deck", true},
              [](double source) { return source != kRangeFinder; });
  rules->Want("EK3_SRC1_VELXY", otherwise, {3, "speed by optical flow is the deck's", true},
              [](double source) { return source != kOpticalFlow; });
}

// Who is listened to, where MAV_OPTIONS bit 0 lets in the ground station only: it, and whoever
// sends with the autopilot's own system, as Kestrel does unless configured otherwise. The ground
// station's place is not Kestrel's to take.
void CheckTrustOfArduPilot(ParameterRules* rules) {
  const auto ground_station = rules->Find("MAV_GCS_SYSID");
  if (!ground_station || !rules->IsSet("MAV_OPTIONS", 0)) return;
  const LinkObservations& link = rules->all().link;
  const std::string measured =
      fmt::format("MAV_OPTIONS bit 0: only the systems {:g} and {} are listened to, Kestrel is {}",
                  *ground_station, link.autopilot_system, link.own_system);
  if (link.own_system == link.autopilot_system || link.own_system == *ground_station) {
    return rules->Add(Good("MAV_GCS_SYSID", measured));
  }
  rules->Add(
      Wrong("MAV_GCS_SYSID", measured,
            "--set fly.link.system_id=0: Kestrel then sends with the autopilot's own system; "
            "leave MAV_GCS_SYSID to the ground station"));
}

// --- When set-points stop ---

// For so long an autopilot flies on with the last set-point when this program or the link fails.
struct LossTimeout {
  std::string_view name;
  double shortest_s;
  double longest_s;
};

void CheckLossTimeout(const LossTimeout& timeout, ParameterRules* rules) {
  constexpr double kWanted_s = 0.3;
  constexpr double kMetres = 0.6;  // beyond it a UAV that descends hits the ground
  const double configured_s = rules->Find(timeout.name).value_or(0);
  rules->Want(timeout.name, configured_s > kMetres ? Verdict::kWrong : Verdict::kDoubtful,
              {kWanted_s, configured_s < timeout.shortest_s
                              ? "it stops whenever the link is slow"
                              : "so long the last velocity and acceleration are flown on when "
                                "set-points stop"},
              [&](double s) { return s >= timeout.shortest_s && s <= timeout.longest_s; });
}

void CheckGuidanceOfArduPilot(ParameterRules* rules) {
  constexpr double kLand = 5;
  constexpr double kReturn = 1;
  CheckLossTimeout({"GUID_TIMEOUT", 0.1, 0.3}, rules);
  if (!rules->all().use.has_position()) return;
  rules->Want("FS_GCS_ENABLE", Verdict::kDoubtful,
              {kReturn,
               "when the ground station is lost it lands where it is, beside a pattern that "
               "moves; 1 returns, 0 leaves it to Kestrel"},
              [](double action) { return action != kLand; });
}

// Checks how fast it turns into the curve of the vehicle that it is guided to.
void CheckAgilityOfArduPilot(ParameterRules* rules) {
  constexpr double kLeastAcceleration = 4;
  constexpr double kAcceleration = 6;
  constexpr double kLeastJerk = 12;
  constexpr double kJerk = 20;
  rules->WantAtLeast(
      "WP_ACC", Verdict::kDoubtful, kLeastAcceleration,
      {kAcceleration, "too little acceleration to come up with a vehicle in a curve"});
  rules->WantAtLeast("PSC_JERK_NE", Verdict::kDoubtful, kLeastJerk,
                     {kJerk, "changes its acceleration too slowly to follow a curve closely"});
}

// The type of a gimbal is not Kestrel's to choose.
void CheckGimbalOfArduPilot(ParameterRules* rules) {
  constexpr double kServo = 1, kMavlinkTargeting = 2;
  const auto type = rules->Find("MNT1_TYPE");
  const int device_id = rules->all().calibration.gimbal->device_id;
  if (!type || device_id > 1) return;  // another mount
  const std::string measured = fmt::format("{:g}", *type);
  if (*type == 0) {
    rules->Add(Wrong("MNT1_TYPE", measured + ": ArduPilot has no gimbal",
                     "the type of the gimbal (6 Gremsy and MAVLink, 8 Siyi, 11 Viewpro, 12 "
                     "Topotek), then reboot"));
  } else if (*type == kServo) {
    rules->Add(Doubtful("MNT1_TYPE", measured + ": servos; the reported attitude is the set-point",
                        "a gimbal that reports its attitude; else kestrel calibrate mount --both "
                        "finds the delay of the servos, and no more"));
  } else {
    rules->Add(Good("MNT1_TYPE", measured));
  }
  rules->Want("MNT1_DEFLT_MODE", Verdict::kDoubtful,
              {kMavlinkTargeting, "it starts retracted, and stays so until it is sent elsewhere"},
              [](double mode) { return mode != 0; });
}

// With --follow Kestrel is the camera in whose images ground stations mark.
void CheckCameraOfArduPilot(ParameterRules* rules) {
  const DoctorObservations& all = rules->all();
  if (all.use.follows) {
    rules->WantExactly("CAM1_TYPE", Verdict::kDoubtful,
                       {0,
                        "ArduPilot answers as a camera, too: ground stations show two, and mark "
                        "in the wrong one",
                        true});
  }
  if (!all.calibration.zoom) return;
  rules->WantExactly("CAM1_HFOV", Verdict::kDoubtful,
                     {0, "it is reported as the field of view, whatever the lens does"});
  if (all.link.zoom_reports > 0 || rules->Find("CAM1_TYPE") != 0) return;
  rules->Add(Doubtful("CAM1_TYPE", "0: ArduPilot has no camera that could report its view",
                      "the type of the camera (4 that of the gimbal, 6 MAVLink), then reboot"));
}

void CheckArduPilot(ParameterRules* rules) {
  if (rules->all().use.no_position) {
    CheckNoPositionOfArduPilot(rules);
    CheckTrustOfArduPilot(rules);
    return CheckGuidanceOfArduPilot(rules);
  }
  CheckPrecisionLandingOfArduPilot(rules);
  if (rules->moves()) CheckMovingTargetOfArduPilot(rules);
  if (rules->moves() || rules->all().use.guides) CheckSpeedsOfArduPilot(rules);
  CheckEstimatorOfArduPilot(rules);
  CheckTrustOfArduPilot(rules);
  if (rules->all().use.guides) CheckGuidanceOfArduPilot(rules);
  if (rules->all().use.has_reserve) CheckReserveOfArduPilot(rules);
  if (rules->all().use.guides && rules->moves()) CheckAgilityOfArduPilot(rules);
  if (rules->all().calibration.gimbal) CheckGimbalOfArduPilot(rules);
  CheckCameraOfArduPilot(rules);
}

// --- PX4 ---

void CheckTargetsOfPx4(ParameterRules* rules) {
  const bool uses_estimator = ProfileOf(rules->all()) == LinkProfile::kPx4Vte;
  if (uses_estimator && !rules->Find("VTE_EN")) {
    rules->Add(Wrong("VTE_EN", "not there: a firmware without the vision target estimator",
                     "--profile px4, or a build with CONFIG_MODULES_VISION_TARGET_ESTIMATOR"));
  }
  rules->WantExactly("VTE_EN", Verdict::kWrong,
                     {uses_estimator ? 1.0 : 0.0,
                      uses_estimator ? "targets of the profile px4-vte are ignored"
                                     : "the target estimator ignores LANDING_TARGET: --profile "
                                       "px4-vte",
                      true});
  if (uses_estimator) {
    rules->WantBit("VTE_AID_MASK", Verdict::kWrong, 1, "the estimator does not use vision");
  }
  if (rules->moves()) {
    rules->WantExactly("LTEST_MODE", Verdict::kWrong,
                       {0,
                        "a target that moves is taken for one that stands, and its speed for "
                        "the UAV's"});
  }
  if (rules->moves() && !rules->all().use.guides) {
    rules->Add(Wrong("moving target",
                     "PX4's own precision landing is for patterns that stand: it trails behind, or "
                     "never descends",
                     "kestrel fly --guide"));
  }
}

// Checks what PX4 does by itself around a precision landing. A pilot who does not know it takes the
// climb of a search for a fly-away.
void CheckSearchOfPx4(ParameterRules* rules) {
  constexpr double kOpportunistic = 1;
  constexpr double kRequired = 2;
  constexpr double kUsualSearches = 3;
  rules->Want("RTL_PLD_MD", Verdict::kDoubtful,
              {kOpportunistic,
               "each return, that of a failsafe too, searches for the pattern until it is found"},
              [](double mode) { return mode != kRequired; });
  rules->Want("PLD_MAX_SRCH", Verdict::kDoubtful,
              {kUsualSearches, "a pattern that is lost once is not searched: it lands without it"},
              [](double searches) { return searches > 0; });
  const double range_m = rules->all().use.sight_range_m;
  const double climb_m = rules->Find("PLD_SRCH_ALT").value_or(0);
  const std::string why = fmt::format(
      "when the pattern is lost it climbs to {:g} m, a surprise, and this camera sees the pattern "
      "from {:.1f} m at most",
      climb_m, range_m);
  rules->Want("PLD_SRCH_ALT", Verdict::kDoubtful, {std::floor(range_m), why},
              [&](double altitude_m) { return range_m == 0 || altitude_m <= range_m; });
}

void CheckLandingOfPx4(ParameterRules* rules) {
  constexpr double kUsualLanding_mps = 0.7;
  const double landing_mps = rules->Find("MPC_LAND_SPEED").value_or(kUsualLanding_mps);
  rules->WantAtLeast("MPC_Z_VEL_MAX_DN", Verdict::kWrong, landing_mps,
                     {std::max(landing_mps, 1.5),
                      "slower than MPC_LAND_SPEED: contact is never "
                      "detected"});
  rules->Want("COM_DISARM_LAND", Verdict::kDoubtful, {2, "the motors run on after the landing"},
              [](double s) { return s > 0; });
}

void CheckEstimatorOfPx4(ParameterRules* rules) {
  constexpr double kRange = 2;
  constexpr double kAlways = 2;
  const bool moves = rules->moves();
  rules->Want("EKF2_HGT_REF", moves ? Verdict::kWrong : Verdict::kDoubtful,
              {1, "height by range finder follows the deck", true},
              [](double source) { return source != kRange; });
  if (!moves) return;
  rules->Want("EKF2_RNG_CTRL", Verdict::kDoubtful,
              {1, "the range finder corrects the height over the deck too"},
              [](double control) { return control < kAlways; });
  rules->WantExactly("EKF2_OF_CTRL", Verdict::kDoubtful,
                     {0, "speed by optical flow is the deck's"});
}

// The reaction of PX4 when set-points stop has to be one that holds. Without a transmitter
// NAV_RCL_ACT sets what follows the modes that need one (0 to 2).
void CheckLossOfPx4(ParameterRules* rules) {
  constexpr int kReturn = 3;
  constexpr int kLand = 4;
  constexpr double kHold = 5;
  CheckLossTimeout({"COM_OF_LOSS_T", 0.1, 0.5}, rules);
  if (!rules->all().use.has_position()) {
    const bool returns = rules->Find("COM_OBL_RC_ACT") == kReturn;
    rules->Want(
        "COM_OBL_RC_ACT", Verdict::kWrong,
        {kLand, returns ? "it climbs and returns when set-points stop"
                        : "it drifts or falls when set-points stop: its position ends, too"},
        [](double reported) { return reported == kLand || reported == kHold; });
    return;
  }
  const int action = static_cast<int>(rules->Find("COM_OBL_RC_ACT").value_or(0));
  const bool flies_on = action < kReturn && rules->Find("NAV_RCL_ACT").value_or(2) == 0;
  const bool falls = action > kHold;
  const char* const why =
      flies_on            ? "with NAV_RCL_ACT 0 the last velocity is flown on for ever when "
                            "set-points stop"
      : falls             ? "the motors stop in the air when set-points stop"
      : action == kReturn ? "it climbs and returns when set-points stop; 5 holds"
      : action == kLand
          ? "it lands where it is when set-points stop; 5 holds"
          : "when set-points stop it waits for the sticks, and drifts without a pilot; "
            "5 holds";
  rules->Want("COM_OBL_RC_ACT", flies_on || falls ? Verdict::kWrong : Verdict::kDoubtful,
              {kHold, why}, [](double reported) { return reported == kHold; });
}

void CheckPilotOfPx4(ParameterRules* rules) {
  constexpr int kInOffboard = 1;
  if (rules->Find("MAN_OVERRIDE_SPD")) {
    rules->Want("MAN_OVERRIDE_SPD", Verdict::kDoubtful,
                {1, "the sticks do not end OFFBOARD, only the mode switch does"},
                [](double speed) { return speed >= 0; });
    return;
  }
  rules->WantBit("COM_RC_OVERRIDE", Verdict::kDoubtful, kInOffboard,
                 "the sticks do not end OFFBOARD, only the mode switch does");
}

void CheckSpeedsOfPx4(ParameterRules* rules) {
  constexpr double kLandingMargin = 1.2;
  const double landing_mps = std::max(1.5, std::ceil(kLandingMargin * rules->target_mps()));
  rules->WantAtLeast("LNDMC_XY_VEL_MAX", Verdict::kWrong, rules->target_mps(),
                     {landing_mps,
                      "on a deck that is faster it never notices that it has landed, "
                      "and does not disarm"});
  rules->WantAtLeast("MPC_XY_VEL_MAX", Verdict::kWrong, rules->target_mps() + 1,
                     {std::ceil(rules->wanted_mps()),
                      "slower than the target and a margin: it "
                      "falls behind"});
}

void CheckGuidanceOfPx4(ParameterRules* rules) {
  CheckLossOfPx4(rules);
  CheckPilotOfPx4(rules);
  const bool stands = rules->all().use.no_position && !rules->moves();
  if (!stands) CheckSpeedsOfPx4(rules);
  CheckTilt("MPC_TILTMAX_AIR", rules);
}

void CheckGimbalOfPx4(ParameterRules* rules) {
  constexpr double kAutomatic = 0, kProtocol = 4, kMavlink = 2;
  if (rules->all().use.points) {
    rules->Want("MNT_MODE_IN", Verdict::kWrong,
                {kProtocol, "set-points of MAVLink's gimbal protocol v2 are ignored", true},
                [](double mode) { return mode == kAutomatic || mode == kProtocol; });
  }
  rules->WantExactly("MNT_MODE_OUT", Verdict::kDoubtful,
                     {kMavlink,
                      "PX4 reports the set-point as the attitude: where the camera looks is not "
                      "known",
                      true});
  if (rules->all().link.gimbal_reports.value_or(0) > 0) return;
  for (const std::string_view name : {"MAV_0_FORWARD", "MAV_1_FORWARD", "MAV_2_FORWARD"}) {
    rules->WantExactly(
        name, Verdict::kDoubtful,
        {1, "reports of a gimbal on another line are not forwarded to this one", true});
  }
}

void CheckPx4(ParameterRules* rules) {
  if (!rules->all().use.guides) {
    CheckTargetsOfPx4(rules);
    CheckSearchOfPx4(rules);
  }
  CheckLandingOfPx4(rules);
  if (rules->all().use.no_position) {
    CheckNoPositionOfPx4(rules);
  } else {
    CheckEstimatorOfPx4(rules);
  }
  if (rules->all().use.pad_position) CheckPadPositionOfPx4(rules);
  if (rules->all().use.guides) CheckGuidanceOfPx4(rules);
  if (rules->all().calibration.gimbal) CheckGimbalOfPx4(rules);
}

}  // namespace

std::span<const ListedCheck> CheckedParameters(AutopilotKind kind) {
  switch (kind) {
    case AutopilotKind::kArduPilot:
      return kOfArduPilot;
    case AutopilotKind::kPx4:
      return kOfPx4;
    case AutopilotKind::kUnknown:
    case AutopilotKind::kOther:
      break;
  }
  return {};
}

Finding CheckProfile(const DoctorObservations& observations) {
  const std::string check = "frame of the target";
  const LinkProfile profile = ProfileOf(observations);
  const AutopilotKind kind = observations.link.kind;
  const bool is_for_px4 = profile != LinkProfile::kArduPilot;
  const bool is_px4 = kind == AutopilotKind::kPx4;
  const std::string measured = fmt::format("profile {} for {}", ToString(profile), ToString(kind));
  if (is_for_px4 == is_px4) return Good(check, measured);
  return Wrong(check,
               measured + (is_px4 ? ": frame BODY_FRD is refused" : ": frame LOCAL_NED is ignored"),
               "--profile auto");
}

Finding CheckLatency(const DoctorObservations& observations) {
  constexpr double kGood_s = 0.06;
  constexpr double kWrong_s = 0.15;
  constexpr double kSlow_s = 0.15;
  constexpr double kTooSlow_s = 0.35;
  constexpr double kShortestLag_s = 0.02;
  constexpr double kLongestLag_s = 0.25;
  constexpr double kRound = 100;  // per second
  const std::string check = "latency";
  const VisionObservations& vision = observations.vision;
  if (vision.frames == 0) return NotChecked(check, "no image was processed");
  const double delay_s = LinkDelayOf(observations);
  const double latency_s = vision.latency_s + delay_s;
  const std::string measured =
      fmt::format("{:.0f} ms from light to message, {:.0f} on the line",
                  kMilliseconds * vision.latency_s, kMilliseconds * delay_s);
  const std::string advice = "a shorter exposure, less buffering, a smaller image, a faster line";
  if (latency_s > kTooSlow_s) return Wrong(check, measured, advice);
  const auto lag = observations.parameters.find("PLND_LAG");
  if (lag != observations.parameters.end()) {
    const double difference_s = std::abs(latency_s - lag->second.value);
    if (difference_s > kGood_s) {
      const double wanted_s =
          std::clamp(std::round(kRound * latency_s) / kRound, kShortestLag_s, kLongestLag_s);
      Finding finding{
          check, difference_s > kWrong_s ? Verdict::kWrong : Verdict::kDoubtful,
          fmt::format("{}; PLND_LAG {:g} s: Kestrel predicts over the difference, and "
                      "ArduPilot circles where the prediction is wrong",
                      measured, lag->second.value),
          fmt::format("param set PLND_LAG {:g}, then reboot; or kestrel doctor --fix", wanted_s)};
      finding.fix = ParameterFix{"PLND_LAG", wanted_s, true};
      return finding;
    }
  }
  if (latency_s > kSlow_s) return Doubtful(check, measured, advice);
  return Good(check, measured);
}

std::vector<Finding> CheckParameters(const DoctorObservations& observations) {
  const AutopilotKind kind = observations.link.kind;
  if (!observations.link.is_heard) return {};
  std::vector<Finding> findings;
  if (!observations.use.guides) findings.push_back(CheckProfile(observations));
  findings.push_back(CheckLatency(observations));
  if (observations.parameters.empty()) {
    findings.push_back(
        NotChecked("parameters", "the autopilot sent none", "a line in both directions"));
    return findings;
  }
  ParameterRules rules(observations);
  if (kind == AutopilotKind::kArduPilot) CheckArduPilot(&rules);
  if (kind == AutopilotKind::kPx4) CheckPx4(&rules);
  std::ranges::move(rules.Take(), std::back_inserter(findings));
  return findings;
}

}  // namespace kestrel
