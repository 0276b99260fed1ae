// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/simulation/recordings/simulated_flight.h"

namespace kestrel {

// Text of region0/data.csv and, for look-alikes, region1/data.csv, ...: a row for each image, of
// the thing that is the body 'thing' of the flight's world.
std::string RegionRowsText(int thing, const SimulatedFlight& flight,
                           const std::vector<double>& image_times_s);

}  // namespace kestrel
