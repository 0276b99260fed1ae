// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/pad_position_checks.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "kestrel/flight/doctor/statistics.h"

namespace kestrel {
namespace {

// ArduPilot takes the smallest delay of the messages for none at all, and this for that one.
void CheckDelayOfArduPilot(ParameterRules* rules) {
  constexpr double kGood_ms = 40, kLongest_ms = 250;
  const DoctorObservations& all = rules->all();
  if (all.vision.frames == 0) return;
  const double latency_ms =
      std::min(std::round(kMilliseconds * (all.vision.latency_s + LinkDelayOf(all))), kLongest_ms);
  rules->Want(
      "VISO_DELAY_MS", Verdict::kDoubtful,
      {latency_ms, "not the time from light to message: its place lags in every turn", true},
      [&](double ms) { return std::abs(ms - latency_ms) <= kGood_ms; });
}

}  // namespace

void CheckPadPositionOfArduPilot(ParameterRules* rules) {
  constexpr double kOdometry = 1, kExternal = 6, kGnss = 3, kCompass = 1, kLand = 3, kBrake = 7;
  constexpr double kLandWithoutStation = 5;
  rules->WantAtLeast("VISO_TYPE", Verdict::kWrong, kOdometry,
                     {kOdometry, "ODOMETRY is ignored", true});
  rules->WantExactly("EK3_SRC1_POSXY", Verdict::kWrong,
                     {kExternal, "its estimator does not take the pad's position"});
  for (const std::string_view name : {"EK3_SRC1_VELXY", "EK3_SRC1_VELZ"}) {
    rules->Want(name, Verdict::kDoubtful,
                {0, "it arms in no mode that holds its place: speed by GNSS or flow is wanted"},
                [](double source) { return source == 0 || source == kExternal; });
  }
  rules->Want("EK3_SRC1_POSZ", Verdict::kWrong, {1, "its height would be by GNSS"},
              [](double source) { return source != kGnss; });
  rules->Want("EK3_SRC1_YAW", Verdict::kWrong, {kCompass, "its heading would be by GNSS"},
              [](double source) { return source == kCompass || source == kExternal; });
  rules->WantExactly("GPS1_TYPE", Verdict::kDoubtful,
                     {0, "modes that hold their place wait for a fix before they arm", true});
  rules->WantExactly("FS_EKF_ACTION", Verdict::kDoubtful,
                     {1, "it drifts when the pad is lost and Kestrel is gone"});
  rules->WantExactly("FENCE_ENABLE", Verdict::kDoubtful,
                     {0, "it arms with a position only, and there is none before the pad is seen"});
  rules->Want("FS_THR_ENABLE", Verdict::kDoubtful,
              {kLand, "when the transmitter is lost it climbs and returns, by the pad's position"},
              [](double action) { return action == 0 || action == kLand || action == kBrake; });
  rules->Want("FS_GCS_ENABLE", Verdict::kDoubtful,
              {kLandWithoutStation,
               "when the ground station is lost it climbs and returns, by the pad's position"},
              [](double action) { return action == 0 || action == kLandWithoutStation; });
  CheckDelayOfArduPilot(rules);
}

void CheckPadPositionOfPx4(ParameterRules* rules) {
  constexpr double kAll = 11, kWanted_us = 500'000, kLongest_us = 1e6, kReturn = 2, kLand = 3;
  rules->Want("EKF2_EV_CTRL", Verdict::kWrong,
              {kAll, "its estimator does not take the pad's position"},
              [](double control) { return (static_cast<unsigned>(control) & 1) != 0; });
  rules->Want("EKF2_NOAID_TOUT", Verdict::kDoubtful,
              {kWanted_us, "so long it flies on by a guess when the pad is lost", true},
              [](double us) { return us <= kLongest_us; });
  rules->WantExactly("EKF2_GPS_CTRL", Verdict::kDoubtful,
                     {0, "it jumps where a fix of GNSS comes"});
  rules->WantExactly("SYS_HAS_GPS", Verdict::kDoubtful,
                     {0, "it warns without GNSS, or does not arm (COM_ARM_WO_GPS)", true});
  rules->Want("NAV_RCL_ACT", Verdict::kDoubtful,
              {kLand, "when the transmitter is lost it climbs and returns, by the pad's position"},
              [](double action) { return action != kReturn; });
}

}  // namespace kestrel
