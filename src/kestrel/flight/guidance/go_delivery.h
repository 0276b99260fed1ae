// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/flight/guidance/guidance_options.h"

namespace kestrel {

// The way of an object to the box: up to the height of travel, to above the box, and down to the
// lowest height without a target, where the gripper opens. m and m/s in the world.
class GoDelivery {
 public:
  explicit GoDelivery(const GuidanceOptions& options);

  // Place and height to which the feet go.
  struct Goal {
    Eigen::Vector2d place;
    double height_m;
  };
  // 'gives_way': to another UAV; it does not come down.
  Goal Choose(const Eigen::Vector2d& box, const Eigen::Vector3d& feet, double travel_m,
              bool gives_way) const;

  // True where the UAV stands still above the box, and low.
  bool MayOpen(const Eigen::Vector2d& box, const Eigen::Vector3d& feet,
               const Eigen::Vector3d& velocity) const;

  // True where others keep away.
  static bool IsNear(const Eigen::Vector2d& box, const Eigen::Vector3d& feet);
  // True for an object that lies in the box.
  static bool IsIn(const Eigen::Vector2d& box, const Eigen::Vector2d& object);

 private:
  double floor_m_;
  double leg_m_;
};

}  // namespace kestrel
