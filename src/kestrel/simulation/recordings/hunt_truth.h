// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/simulation/recordings/simulated_flight.h"
#include "kestrel/simulation/scene/hunt_objects.h"

namespace kestrel {

// The files of objects0: the objects with their digits, and where each is seen in which image.
std::string ObjectsText(const std::vector<HuntObject>& objects);
std::string ObjectRowsText(const std::vector<HuntObject>& objects, const SimulatedFlight& flight);
std::string DigitsText(const std::vector<HuntObject>& objects);

}  // namespace kestrel
