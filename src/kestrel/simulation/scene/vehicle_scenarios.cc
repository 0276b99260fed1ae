// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/vehicle_scenarios.h"

namespace kestrel {

std::span<const VehicleScenario> HardVehicles() {
  static const std::vector<VehicleScenario> vehicles = {
      {"road", "50 km/h straight on", {"vehicle.path=straight", "vehicle.speed_mps=13.9"}},
      {"lanes",
       "50 km/h, from one lane to the other and back",
       {"vehicle.path=lanes", "vehicle.speed_mps=13.9"}},
      {"motorway", "80 km/h straight on", {"vehicle.path=straight", "vehicle.speed_mps=22.2"}},
      {"ship",
       "sails at 2 m/s, heaves by 1 m in 6 s and rolls by 8 degrees",
       {"vehicle.path=straight", "vehicle.speed_mps=2", "vehicle.heave_m=1", "vehicle.roll_deg=8"}},
      {"stops", "drives off, stops and turns on the spot, again and again", {"vehicle.path=stops"}},
  };
  return vehicles;
}

}  // namespace kestrel
