// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/parameter_names.h"

namespace kestrel {
namespace {

// ArduCopter 4.7 changed from centimetres and hundredths of a degree to metres and degrees.
constexpr double kCenti = 0.01;

constexpr std::array<ParameterNames, 21> kRenamed = {{
    {{{{"ATC_ANGLE_MAX"}, {"ANGLE_MAX", kCenti}}}},
    {{{{"LAND_ALT_LOW_M"}, {"LAND_ALT_LOW", kCenti}}}},
    {{{{"LAND_SPD_HIGH_MS"}, {"LAND_SPEED_HIGH", kCenti}}}},
    {{{{"LAND_SPD_MS"}, {"LAND_SPEED", kCenti}}}},
    {{{{"MAV_GCS_SYSID"}, {"SYSID_MYGCS"}}}},
    {{{{"MAV_SYSID"}, {"SYSID_THISMAV"}}}},
    {{{{"PILOT_SPD_DN"}, {"PILOT_SPEED_DN", kCenti}}}},
    {{{{"PILOT_SPD_UP"}, {"PILOT_SPEED_UP", kCenti}}}},
    {{{{"PSC_JERK_D"}, {"PSC_D_JERK"}, {"PSC_JERK_Z"}}}},
    {{{{"PSC_JERK_NE"}, {"PSC_NE_JERK"}, {"PSC_JERK_XY"}}}},
    {{{{"PSC_NE_POS_P"}, {"PSC_POSXY_P"}}}},
    {{{{"PSC_NE_VEL_D"}, {"PSC_VELXY_D"}}}},
    {{{{"PSC_NE_VEL_I"}, {"PSC_VELXY_I"}}}},
    {{{{"PSC_NE_VEL_P"}, {"PSC_VELXY_P"}}}},
    {{{{"RTL_ALT_M"}, {"RTL_ALT", kCenti}}}},
    {{{{"RTL_SPEED_MS"}, {"RTL_SPEED", kCenti}}}},
    {{{{"WP_ACC"}, {"WPNAV_ACCEL", kCenti}}}},
    {{{{"WP_ACC_Z"}, {"WPNAV_ACCEL_Z", kCenti}}}},
    {{{{"WP_SPD"}, {"WPNAV_SPEED", kCenti}}}},
    {{{{"WP_SPD_DN"}, {"WPNAV_SPEED_DN", kCenti}}}},
    {{{{"WP_SPD_UP"}, {"WPNAV_SPEED_UP", kCenti}}}},
}};

}  // namespace

ParameterNames NamesOf(std::string_view name) {
  for (const ParameterNames& renamed : kRenamed) {
    if (renamed.names[0].name == name) return renamed;
  }
  ParameterNames names;
  names.names[0].name = name;
  return names;
}

}  // namespace kestrel
