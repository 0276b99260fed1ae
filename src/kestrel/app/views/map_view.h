// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <optional>

#include "kestrel/app/views/view_data.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// Puts the camera on the map if its pose is known. The heading is that of the image's upper edge.
inline void PlaceUav(const std::optional<RigidTransform>& world_from_camera, ViewMap* map) {
  if (!world_from_camera) return;
  map->uav = world_from_camera->translation.head<2>();
  const Eigen::Vector3d up =
      world_from_camera->rotation * Eigen::Vector3d(-Eigen::Vector3d::UnitY());
  map->uav_heading = std::atan2(up.y(), up.x());
}

}  // namespace kestrel
