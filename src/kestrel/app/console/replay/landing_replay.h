// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/console/replay/replay_search.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// Returns a search for the landing pattern like `kestrel land`. 'sources': the recording's, where
// the truth may be. 'altitude_m': height of the camera above the pattern, where there are no poses.
std::unique_ptr<ReplaySearch> SearchForPattern(const std::vector<std::string>& sources,
                                               const LandingPipelineOptions& options,
                                               std::optional<double> altitude_m);

}  // namespace kestrel
