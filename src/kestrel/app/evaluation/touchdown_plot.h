// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/app/evaluation/plot.h"
#include "kestrel/simulation/recordings/touchdown_result.h"

namespace kestrel {

// Returns the paths of the UAV and of the vehicle from above and from the side, the latter in the
// vertical plane through the first and the last position of the UAV.
Plot TouchdownPlot(const TouchdownResult& result);

}  // namespace kestrel
