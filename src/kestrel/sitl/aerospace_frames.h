// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Geometry>

// Between Kestrel's frames (world ENU, body FLU) and those on the wire (NED, FRD). Each of the
// turns is its own inverse.
namespace kestrel {

inline Eigen::Vector3d NedFromEnu(const Eigen::Vector3d& v) { return {v.y(), v.x(), -v.z()}; }
inline Eigen::Vector3d EnuFromNed(const Eigen::Vector3d& v) { return NedFromEnu(v); }
inline Eigen::Vector3d FrdFromFlu(const Eigen::Vector3d& v) { return {v.x(), -v.y(), -v.z()}; }
inline Eigen::Vector3d FluFromFrd(const Eigen::Vector3d& v) { return FrdFromFlu(v); }

// ned_from_frd of enu_from_flu; w is not negative.
inline Eigen::Quaterniond NedFromFrd(const Eigen::Quaterniond& enu_from_flu) {
  const double half = std::sqrt(0.5);
  const Eigen::Quaterniond ned_from_enu(0, half, half, 0);
  const Eigen::Quaterniond flu_from_frd(0, 1, 0, 0);
  Eigen::Quaterniond q = ned_from_enu * enu_from_flu * flu_from_frd;
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return q;
}

}  // namespace kestrel
