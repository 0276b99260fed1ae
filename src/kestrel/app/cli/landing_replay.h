// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "kestrel/app/cli/replay_search.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// Returns a search for the landing pattern like `kestrel land`. 'source' outlives the search.
std::unique_ptr<ReplaySearch> SearchForPattern(const SourceArguments& source,
                                               const LandingPipelineOptions& options);

}  // namespace kestrel
