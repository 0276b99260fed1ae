// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

namespace kestrel {

// A named vehicle: its changes to the default options of a scene.
struct VehicleScenario {
  const char* name;
  const char* meaning;
  std::vector<const char*> settings;  // "key=value"
};

// Vehicles that are harder to land on than the contest's, of `sim:` and of
// `kestrel simulate touchdown` alike.
std::span<const VehicleScenario> HardVehicles();

}  // namespace kestrel
