// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/vision/mapping/mapped_object.h"

namespace kestrel {

// An object of the map that a team of UAVs shares.
struct TeamObject {
  MappedObject object;
  std::vector<std::string> uavs;  // names of the UAVs that have it in their maps
  std::string holder;             // name of the UAV that goes for it; empty: none
};

}  // namespace kestrel
