// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

// Names, units and defaults of ArduCopter 4.7, with precision landing enabled, and with what doctor
// recommends: the default of GUID_TIMEOUT is 3.
std::vector<AutopilotParameter> ArduPilotDefaults() {
  return {{"ATC_ANGLE_MAX", 30, false},
          {"BATT_FS_CRT_ACT", 0, true},
          {"BATT_FS_LOW_ACT", 0, true},
          {"DISARM_DELAY", 10, true},
          {"EK3_SRC1_POSXY", 3, true},
          {"EK3_SRC1_POSZ", 1, true},
          {"EK3_SRC1_VELXY", 3, true},
          {"EK3_SRC1_VELZ", 3, true},
          {"EK3_SRC1_YAW", 1, true},
          {"GPS1_TYPE", 1, true},
          {"FENCE_ACTION", 1, true},
          {"FENCE_ALT_MAX", 100, false},
          {"FENCE_ALT_MIN", -10, false},
          {"FENCE_ENABLE", 0, true},
          {"FENCE_MARGIN", 2, false},
          {"FENCE_RADIUS", 300, false},
          {"FENCE_TYPE", 7, true},
          {"FS_EKF_ACTION", 1, true},
          {"FS_EKF_THRESH", 0.8, false},
          {"FS_GCS_ENABLE", 0, true},
          {"FS_THR_ENABLE", 1, true},
          {"GUID_OPTIONS", 0, true},
          {"GUID_TIMEOUT", 0.3, false},
          {"LAND_ALT_LOW_M", 10, false},
          {"LAND_SPD_HIGH_MS", 0, false},
          {"LAND_SPD_MS", 0.5, false},
          {"MAV1_OPTIONS", 0, true},
          {"MAV_GCS_SYSID", 255, true},
          {"MAV_OPTIONS", 0, true},
          {"MAV_SYSID", 1, true},
          {"MNT1_DEFLT_MODE", 3, true},
          {"MNT1_PITCH_MAX", 20, true},
          {"MNT1_PITCH_MIN", -90, true},
          {"MNT1_TYPE", 0, true},
          {"PILOT_THR_BHV", 0, true},
          {"PLND_ALT_MAX", 8, false},
          {"PLND_ALT_MIN", 0.75, false},
          {"PLND_CAM_POS_X", 0, false},
          {"PLND_CAM_POS_Y", 0, false},
          {"PLND_CAM_POS_Z", 0, false},
          {"PLND_ENABLED", 1, true},
          {"PLND_EST_TYPE", 1, true},
          {"PLND_LAG", 0.02, false},
          {"PLND_OPTIONS", 0, true},
          {"PLND_ORIENT", 25, true},
          {"PLND_RET_MAX", 4, true},
          {"PLND_STRICT", 1, true},
          {"PLND_TYPE", 1, true},
          {"PLND_XY_DIST_MAX", 2.5, false},
          {"PLND_YAW_ALIGN", 0, false},
          {"PSC_D_POS_P", 1, false},
          {"PSC_JERK_D", 5, false},
          {"PSC_JERK_NE", 5, false},
          {"PSC_NE_POS_P", 1, false},
          {"PSC_NE_VEL_D", 0.25, false},
          {"PSC_NE_VEL_I", 1, false},
          {"PSC_NE_VEL_P", 2, false},
          {"RNGFND1_ORIENT", 25, true},
          {"RNGFND1_TYPE", 0, true},
          {"RTL_ALT_M", 15, false},
          {"SERIAL2_BAUD", 921, true},
          {"SERIAL2_PROTOCOL", 2, true},
          {"VISO_DELAY_MS", 10, true},
          {"VISO_TYPE", 0, true},
          {"WP_ACC", 2.5, false},
          {"WP_ACC_Z", 1, false},
          {"WP_SPD", 10, false},
          {"WP_SPD_DN", 1.5, false},
          {"WP_SPD_UP", 2.5, false},
          {"WP_YAW_BEHAVIOR", 2, true}};
}

// Likewise: COM_OBL_RC_ACT is 0 as it comes.
std::vector<AutopilotParameter> Px4Defaults() {
  return {{"COM_DISARM_LAND", 2, false},    {"COM_DL_LOSS_T", 10, true},
          {"COM_FAIL_ACT_T", 5, false},     {"COM_LOW_BAT_ACT", 0, true},
          {"COM_OBL_RC_ACT", 5, true},      {"COM_OF_LOSS_T", 1, false},
          {"COM_RCL_EXCEPT", 0, true},      {"COM_RC_IN_MODE", 3, true},
          {"COM_RC_LOSS_T", 0.5, false},    {"COM_RC_OVERRIDE", 1, true},
          {"EKF2_EV_CTRL", 0, true},        {"EKF2_GPS_CTRL", 7, true},
          {"EKF2_HGT_REF", 1, true},        {"EKF2_NOAID_TOUT", 5e6, true},
          {"EKF2_OF_CTRL", 0, true},        {"EKF2_RNG_CTRL", 1, true},
          {"GF_ACTION", 2, true},           {"GF_MAX_HOR_DIST", 0, false},
          {"GF_MAX_VER_DIST", 0, false},    {"LNDMC_XY_VEL_MAX", 1.5, false},
          {"LNDMC_Z_VEL_MAX", 0.25, false}, {"LTEST_MODE", 0, true},
          {"LTEST_SENS_ROT", 2, true},      {"MAV_1_CONFIG", 102, true},
          {"MAV_1_FORWARD", 1, true},       {"MAV_1_MODE", 2, true},
          {"MAV_FWDEXTSP", 1, true},        {"MAV_SYS_ID", 1, true},
          {"MNT_MODE_IN", -1, true},        {"MNT_MODE_OUT", 0, true},
          {"MPC_ACC_HOR", 3, false},        {"MPC_ACC_HOR_MAX", 5, false},
          {"MPC_LAND_ALT1", 10, false},     {"MPC_LAND_ALT2", 5, false},
          {"MPC_LAND_SPEED", 0.7, false},   {"MPC_TILTMAX_AIR", 45, false},
          {"MPC_XY_CRUISE", 5, false},      {"MPC_XY_P", 0.95, false},
          {"MPC_XY_VEL_D_ACC", 0.2, false}, {"MPC_XY_VEL_I_ACC", 0.4, false},
          {"MPC_XY_VEL_MAX", 12, false},    {"MPC_XY_VEL_P_ACC", 1.8, false},
          {"MPC_YAWRAUTO_MAX", 60, false},  {"MPC_Z_P", 1, false},
          {"MPC_Z_VEL_D_ACC", 0, false},    {"MPC_Z_VEL_I_ACC", 2, false},
          {"MPC_Z_VEL_MAX_DN", 1.5, false}, {"MPC_Z_VEL_MAX_UP", 3, false},
          {"MPC_Z_VEL_P_ACC", 4, false},    {"MPC_Z_V_AUTO_DN", 1.5, false},
          {"NAV_DLL_ACT", 0, true},         {"NAV_RCL_ACT", 2, true},
          {"PLD_BTOUT", 5, false},          {"PLD_FAPPR_ALT", 0.1, false},
          {"PLD_HACC_RAD", 0.2, false},     {"PLD_MAX_SRCH", 3, true},
          {"PLD_SRCH_ALT", 10, false},      {"PLD_SRCH_TOUT", 10, false},
          {"RTL_PLD_MD", 0, true},          {"RTL_RETURN_ALT", 60, false},
          {"SER_TEL2_BAUD", 921600, true},  {"SYS_HAS_GPS", 1, true},
          {"VTE_AID_MASK", 6, true},        {"VTE_EN", 0, true}};
}

}  // namespace

AutopilotParameters::AutopilotParameters(AutopilotFirmware firmware)
    : parameters_(firmware == AutopilotFirmware::kPx4 ? Px4Defaults() : ArduPilotDefaults()) {
  if (firmware == AutopilotFirmware::kPx4) return;
  constexpr int kChannels = 16;  // as many as the transmitter has
  for (int i = 1; i <= kChannels; ++i) {
    parameters_.push_back({fmt::format("RC{}_OPTION", i), 0, true});
  }
}

double AutopilotParameters::operator[](std::string_view name) const {
  const auto index = Find(name);
  if (!index) throw InputError(fmt::format("the simulated autopilot has no parameter {}", name));
  return parameters_[*index].value;
}

std::optional<std::size_t> AutopilotParameters::Find(std::string_view name) const {
  const auto found = std::ranges::find(parameters_, name, &AutopilotParameter::name);
  if (found == parameters_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - parameters_.begin());
}

void AutopilotParameters::Set(std::size_t index, double value) {
  AutopilotParameter& parameter = parameters_[index];
  parameter.value = parameter.is_integer ? std::round(value) : value;
}

}  // namespace kestrel
