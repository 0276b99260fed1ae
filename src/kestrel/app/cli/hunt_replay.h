// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "kestrel/app/cli/replay_search.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// Returns a search for the model's objects like `kestrel hunt`. 'source' outlives the search.
std::unique_ptr<ReplaySearch> SearchForObjects(const SourceArguments& source,
                                               const HuntPipelineOptions& options,
                                               const ObjectModel& model);

}  // namespace kestrel
