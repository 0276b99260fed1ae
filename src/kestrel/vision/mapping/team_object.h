// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/vision/mapping/mapped_object.h"

namespace kestrel {

// An object of the map that a team of UAVs shares.
struct TeamObject {
  MappedObject object;
  std::vector<std::string> uavs;  // that have it in their maps, by name
  std::string holder;             // the one that goes for it; empty: none
};

}  // namespace kestrel
