// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "kestrel/app/fly/fly_source.h"
#include "kestrel/app/options/fly_options.h"
#include "kestrel/flight/onboard/session.h"
#include "kestrel/simulation/autopilots/simulated_autopilot.h"

namespace kestrel {

// The autopilot of a flight and the URL to reach it.
struct FlyAutopilot {
  std::string url;
  std::unique_ptr<SimulatedAutopilot> simulated;  // null: a real autopilot, or none
};

// Evaluates the name of an autopilot: a URL, or "sim:ardupilot" and "sim:px4", which make a
// simulated one, not yet started, in the world of 'source', which gets a standing one if it has
// none. Where Kestrel guides, its pilot lets it do that and its PX4 is set up for moving decks. The
// source must outlive it. Throws InputError when the options are not valid.
FlyAutopilot MakeFlyAutopilot(const std::string& name, const FlyOptions& options, bool guides,
                              FlySource* source);

// The options of a session with this autopilot.
SessionOptions SessionOptionsFor(const FlyAutopilot& autopilot, const FlyOptions& options,
                                 bool guides);

}  // namespace kestrel
