// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kestrel/simulation/recordings/follow_simulation.h"
#include "kestrel/simulation/recordings/hunt_simulation.h"
#include "kestrel/simulation/recordings/landing_simulation.h"
#include "kestrel/simulation/recordings/touchdown_simulation.h"

namespace kestrel {

// A named flight: its changes to the default options.
struct Scenario {
  const char* name;
  const char* meaning;
  std::vector<const char*> settings;  // "key=value", as for --set
};

// The flights of `kestrel simulate landing`, `hunt`, `follow` and `touchdown`.
std::span<const Scenario> LandingScenarios();
std::span<const Scenario> HuntScenarios();
std::span<const Scenario> FollowScenarios();
std::span<const Scenario> TouchdownScenarios();

// Returns the options of a scenario, changed by those of the file (if not empty), and then by the
// settings "key=value". Throws InputError when the scenario does not exist, a setting is wrong, or
// the result is not valid.
LandingSimulationOptions ReadLandingSimulation(const std::string& scenario,
                                               const std::string& config_file,
                                               const std::vector<std::string>& settings);
HuntSimulationOptions ReadHuntSimulation(const std::string& scenario,
                                         const std::string& config_file,
                                         const std::vector<std::string>& settings);
FollowSimulationOptions ReadFollowSimulation(const std::string& scenario,
                                             const std::string& config_file,
                                             const std::vector<std::string>& settings);
TouchdownSimulationOptions ReadTouchdownSimulation(const std::string& scenario,
                                                   const std::string& config_file,
                                                   const std::vector<std::string>& settings);

}  // namespace kestrel
