// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// The leans of a UAV at which a camera that is fixed to it loses a target out of the image.
class ViewLimits {
 public:
  // Throws InputError when the lens is not valid.
  ViewLimits(const CameraIntrinsics& lens, const RigidTransform& body_from_camera);

  // Largest leans, rad.
  struct Leans {
    double forward = 0;
    double back = 0;
    double side = 0;
  };
  // Returns the leans of a UAV whose nose points to a target 'ahead_m' away and 'below_m' lower.
  // They are never so small that it could not move.
  Leans LeansFor(double ahead_m, double below_m) const;

  // True when a UAV that does not lean sees that target.
  bool Sees(double ahead_m, double below_m) const;

 private:
  bool SeesLeaning(const Eigen::Vector3d& axis, double lean, const Eigen::Vector3d& target) const;
  double Largest(const Eigen::Vector3d& axis, const Eigen::Vector3d& target) const;

  CameraModel camera_;
  RigidTransform camera_from_body_;
};

}  // namespace kestrel
