// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/no_position_checks.h"

#include <cmath>
#include <string>

namespace kestrel {

namespace {

// It is learnt in flight, not set.
void CheckHoverThrust(ParameterRules* rules) {
  constexpr double kAsItComes = 0.35, kSame = 1e-4;
  const auto thrust = rules->Find("MOT_THST_HOVER");
  if (!thrust) return;
  const std::string measured = fmt::format("{:g}", *thrust);
  rules->Add(std::abs(*thrust - kAsItComes) > kSame
                 ? Good("MOT_THST_HOVER", measured)
                 : Doubtful("MOT_THST_HOVER",
                            measured +
                                ", as it comes: not learnt, it sinks or climbs when the mode "
                                "is given",
                            "MOT_HOVER_LEARN 2, then hover for 10 s in ALT_HOLD"));
}

}  // namespace

void CheckReserveOfArduPilot(ParameterRules* rules) {
  constexpr unsigned kTakesThrust = 8;
  const auto options = static_cast<unsigned>(rules->Find("GUID_OPTIONS").value_or(0));
  rules->Want("GUID_OPTIONS", Verdict::kWrong,
              {static_cast<double>(options & ~kTakesThrust),
               "bit 3: a climb rate is taken for a thrust, and guidance refuses"},
              [](double value) { return (static_cast<unsigned>(value) & kTakesThrust) == 0; });
}

void CheckNoPositionOfArduPilot(ParameterRules* rules) {
  constexpr double kLandsAlways = 3;
  CheckReserveOfArduPilot(rules);
  rules->WantExactly("FENCE_ENABLE", Verdict::kWrong, {0, "it does not arm without a position"});
  rules->Want("FS_EKF_ACTION", Verdict::kDoubtful,
              {1, "it lands in any mode once its estimator has lost the position"},
              [](double action) { return action != kLandsAlways; });
  CheckHoverThrust(rules);
}

void CheckNoPositionOfPx4(ParameterRules* rules) {
  rules->WantAtLeast("COM_ARM_WO_GPS", Verdict::kWrong, 1,
                     {1, "it does not arm without a position"});
  rules->WantExactly("SYS_HAS_GPS", Verdict::kDoubtful,
                     {0, "it warns without GNSS, or does not arm (COM_ARM_WO_GPS)", true});
  rules->WantExactly(
      "MPC_USE_HTE", Verdict::kDoubtful,
      {1, "its hover thrust is not learnt: it sinks or climbs when the mode is given"});
}

}  // namespace kestrel
