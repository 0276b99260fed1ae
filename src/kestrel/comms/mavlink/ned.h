// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

// Conversion between the frames of autopilots (world north-east-down, body forward-right-down) and
// Kestrel's (world east-north-up, body forward-left-up). Each function is its own inverse.
namespace kestrel {

inline Eigen::Vector3d EnuFromNed(const Eigen::Vector3d& v) { return {v.y(), v.x(), -v.z()}; }
inline Eigen::Vector3d NedFromEnu(const Eigen::Vector3d& v) { return EnuFromNed(v); }
inline Eigen::Vector3d FluFromFrd(const Eigen::Vector3d& v) { return {v.x(), -v.y(), -v.z()}; }
inline Eigen::Vector3d FrdFromFlu(const Eigen::Vector3d& v) { return FluFromFrd(v); }

// Converts the rotation "NED from FRD" to "ENU from FLU", and back.
inline Eigen::Quaterniond EnuFluFromNedFrd(const Eigen::Quaterniond& ned_from_frd) {
  const Eigen::Quaterniond enu_from_ned(0, std::sqrt(0.5), std::sqrt(0.5), 0);
  const Eigen::Quaterniond frd_from_flu(0, 1, 0, 0);
  return enu_from_ned * ned_from_frd * frd_from_flu;
}
inline Eigen::Quaterniond NedFrdFromEnuFlu(const Eigen::Quaterniond& enu_from_flu) {
  return EnuFluFromNedFrd(enu_from_flu);
}

}  // namespace kestrel
