// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/core/base/limits.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// A hall around the origin, whose walls a camera sees. Nothing holds a UAV in it: that it would
// have touched wall or ceiling is reported.
struct RoomOptions {
  double side_m = 0;
  double ceiling_m = 5;

  static void Visit(auto& self, auto&& visit) {
    visit("side_m", self.side_m, Range{0, 1000}, "length and width; 0: there is no room");
    visit("ceiling_m", self.ceiling_m, Range{1, 100}, "height of the ceiling");
  }
  bool is_there() const { return side_m > 0; }
  // False when a UAV whose middle is there touches wall or ceiling.
  bool HasSpaceAt(const Eigen::Vector3d& position) const;
};

// Adds the walls.
void AddRoom(const RoomOptions& options, World* world);

}  // namespace kestrel
