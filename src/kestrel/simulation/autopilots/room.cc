// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/room.h"

#include "kestrel/simulation/scene/paint.h"
#include "kestrel/simulation/scene/solids.h"

namespace kestrel {

bool RoomOptions::HasSpaceAt(const Eigen::Vector3d& position) const {
  constexpr double kUav_m = 0.3;  // from its middle to its rotors' tips
  return !is_there() || (position.z() + kUav_m < ceiling_m &&
                         position.head<2>().lpNorm<Eigen::Infinity>() + kUav_m < side_m / 2);
}

void AddRoom(const RoomOptions& options, World* world) {
  constexpr double kThickness_m = 0.1;
  const auto paint = PlainPaint(Gray(0.6), world->channels);
  const double half = options.side_m / 2, high = options.ceiling_m / 2, thick = kThickness_m / 2;
  for (const double end : {-half - thick, half + thick}) {
    AddBox(0, {{end, 0, high}, {thick, half, high}}, paint, paint, world);
    AddBox(0, {{0, end, high}, {half, thick, high}}, paint, paint, world);
  }
}

}  // namespace kestrel
