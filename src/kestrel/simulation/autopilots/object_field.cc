// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/object_field.h"

#include <cmath>
#include <cstddef>

namespace kestrel {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Each object's surfaces are on a body of its own, which is far below the ground once it is taken.
void ObjectField::Draw(const ObjectFieldOptions& options, Random* random, World* world) {
  constexpr double kDeep_m = 1000;
  objects_ = AddHuntObjects(options.objects, 0.5 * Vector2d(options.length_m, options.width_m),
                            random, world);
  taken_.emplace(options.shared_file, objects_.size());
  for (std::size_t number = 0; number < objects_.size(); ++number) {
    const HuntObject& object = objects_[number];
    const std::atomic<bool>& is_taken = (*taken_)[number];
    const Motion there = world->bodies[world->surfaces[object.first_surface].body];
    const int body = static_cast<int>(world->bodies.size());
    world->bodies.push_back([&is_taken, there](double time_s) {
      RigidTransform place = there(time_s);
      if (is_taken) place.translation.z() -= kDeep_m;
      return place;
    });
    for (std::size_t i = object.first_surface; i < object.last_surface; ++i) {
      world->surfaces[i].body = body;
    }
  }
}

std::optional<ObjectField::Grab> ObjectField::Close(double time_s, const Vector3d& gripper) {
  constexpr double kEdge_m = 0.03;
  constexpr double kReach_m = 0.1;
  std::optional<std::size_t> nearest;
  Vector3d way(0, 0, 0);
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const Vector3d to = gripper - objects_[i].center(time_s);
    if (is_taken(i) || (nearest && to.norm() >= way.norm())) continue;
    nearest = i;
    way = to;
  }
  if (!nearest) return std::nullopt;
  const double half_m = objects_[*nearest].half_size.minCoeff();
  Grab grab{objects_[*nearest].id, way.head<2>().norm(), way.z()};
  const bool is_within = grab.offset_m < half_m - kEdge_m && std::abs(grab.height_m) < kReach_m;
  grab.is_taken = is_within && taken_->Take(*nearest);
  return grab;
}

}  // namespace kestrel
