// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "kestrel/app/options/fly_options.h"
#include "kestrel/simulation/autopilots/simulated_autopilot.h"
#include "kestrel/simulation/autopilots/simulated_source.h"

namespace kestrel {

// The autopilot of a flight and the URL to reach it.
struct FlyAutopilot {
  std::string url;
  std::unique_ptr<SimulatedAutopilot> simulated;  // null: a real autopilot
};

// Evaluates the argument --autopilot. "sim:ardupilot" and "sim:px4" make a simulated autopilot, not
// yet started, in the world of 'source', which gets a standing one if it has none. The source must
// outlive it. Throws InputError when the options are not valid.
FlyAutopilot MakeFlyAutopilot(const std::string& argument, const FlyOptions& options,
                              SimulatedSource* source);

}  // namespace kestrel
