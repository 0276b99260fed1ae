// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/go_delivery.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// The UAV sinks within the first distance of the box, others keep away within the second one, and
// the gripper opens within the last one while the UAV stands still.
constexpr double kAtBox_m = 1.5, kNearBox_m = 3, kOverBox_m = 0.4, kOverBox_mps = 0.4;
constexpr double kDown_m = 0.1;  // from the lowest height, to which the UAV comes ever more slowly
constexpr double kClimbed_m = 1.5;  // from the height of travel: high enough to set out

double DistanceTo(const Vector2d& box, const Vector3d& feet) {
  return (feet.head<2>() - box).norm();
}

}  // namespace

GoDelivery::GoDelivery(const GuidanceOptions& options)
    : floor_m_(options.limits.floor_m), leg_m_(options.leg_m) {}

GoDelivery::Goal GoDelivery::Choose(const Vector2d& box, const Vector3d& feet, double travel_m,
                                    bool gives_way) const {
  if (DistanceTo(box, feet) <= kAtBox_m && !gives_way) return {box, floor_m_ - leg_m_};
  const bool is_up = feet.z() > travel_m - kClimbed_m || IsNear(box, feet);
  return {is_up ? box : Vector2d(feet.head<2>()), travel_m};
}

bool GoDelivery::MayOpen(const Vector2d& box, const Vector3d& feet,
                         const Vector3d& velocity) const {
  return DistanceTo(box, feet) <= kOverBox_m && velocity.norm() <= kOverBox_mps &&
         feet.z() < floor_m_ + kDown_m;
}

bool GoDelivery::IsNear(const Vector2d& box, const Vector3d& feet) {
  return DistanceTo(box, feet) < kNearBox_m;
}

bool GoDelivery::IsIn(const Vector2d& box, const Vector2d& object) {
  return (object - box).norm() < kAtBox_m;
}

}  // namespace kestrel
