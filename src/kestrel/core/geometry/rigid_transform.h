// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace kestrel {

// Rigid transform that maps coordinates in frame A to frame B: p_in_b = rotation * p_in_a +
// translation. Named by cancellation: c_from_a = c_from_b * b_from_a. Metres.
struct RigidTransform {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation * point + translation;
  }
  RigidTransform operator*(const RigidTransform& other) const {
    return {(rotation * other.rotation).normalized(), rotation * other.translation + translation};
  }
  RigidTransform Inverse() const {
    const Eigen::Quaterniond inverse = rotation.conjugate();
    return {inverse, -(inverse * translation)};
  }
};

// Returns the direction, about the world's z axis, of the x axis of a frame that 'rotation' maps to
// the world: rad from x to y.
inline double HeadingOf(const Eigen::Quaterniond& rotation) {
  const Eigen::Vector3d forward = rotation * Eigen::Vector3d::UnitX();
  return std::atan2(forward.y(), forward.x());
}

// Returns the heading that the x axis has once the frame is levelled by the shortest rotation: that
// of a UAV which touches a level deck with a lean and then stands on it. rad from x to y. The twist
// about z of the swing-twist decomposition; not defined upside down.
inline double LevelHeadingOf(const Eigen::Quaterniond& rotation) {
  return std::remainder(2 * std::atan2(rotation.z(), rotation.w()), 2 * std::numbers::pi);
}

// Returns the rotation for a rotation vector: about its direction, by its length in rad.
inline Eigen::Quaterniond RotationBy(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (!(angle > 0)) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle));
}

// The inverse of RotationBy: returns the rotation vector of 'rotation', no longer than pi.
inline Eigen::Vector3d RotationVector(const Eigen::Quaterniond& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

// Returns 'pose' moved by a translation and turned about its own origin by a rotation vector (rad),
// both in the frame that it maps to.
inline RigidTransform Moved(const RigidTransform& pose, const Eigen::Vector3d& translation,
                            const Eigen::Vector3d& turn) {
  return {(RotationBy(turn) * pose.rotation).normalized(), pose.translation + translation};
}

}  // namespace kestrel
