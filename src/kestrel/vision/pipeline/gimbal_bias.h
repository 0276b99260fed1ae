// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Learns the three angles by which the camera on a gimbal looks beside where mount and reports put
// it, in flight, over a pad that stands: seen from other distances and directions, a wrong angle
// moves the pad. An error-state Kalman filter of the pad's place, which wanders as the UAV's
// position does, and of the angles, which drift slowly. A pad that moves teaches nothing.
class GimbalBias {
 public:
  static constexpr double kPrior_rad = 0.01;  // standard deviation per axis before the first sight

  struct Sight {
    Time time;
    Eigen::Vector3d center_in_camera;
    Eigen::Quaterniond world_from_camera;  // with all that was learnt before
    Eigen::Vector3d center_in_world;       // by that rotation
    Eigen::Matrix3d covariance;            // m^2, in the world, of errors that frames do not share
    double wander_m = 0;                   // of the UAV's position, per axis, in a minute
  };

  // Takes a sight of a pad that stands. Returns the turn by which the camera's axes are to be
  // turned further, in those axes: world_from_camera * turn. Identity where nothing was learnt.
  Eigen::Quaterniond Add(const Sight& sight);

  // The pad has moved: its place is not known any more.
  void Forget() { newest_.reset(); }

  // Standard deviation of the angles about the camera's axes, rad.
  Eigen::Vector3d sigma_rad() const;

 private:
  using State = Eigen::Matrix<double, 6, 1>;  // error of the place (m), of the angles (rad)

  void Begin(const Sight& sight);
  bool IsTurning(const Sight& sight) const;

  std::optional<Sight> newest_;
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 6, 6> covariance_ =
      Eigen::Vector<double, 6>(0, 0, 0, 1, 1, 1).asDiagonal() *
      Eigen::Matrix<double, 6, 6>::Identity() * (kPrior_rad * kPrior_rad);
};

}  // namespace kestrel
