// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/console/replay/replay_search.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// Returns a search for the model's objects like `kestrel hunt`. Arguments as in SearchForPattern.
std::unique_ptr<ReplaySearch> SearchForObjects(const std::vector<std::string>& sources,
                                               const HuntPipelineOptions& options,
                                               const ObjectModel& model,
                                               std::optional<double> altitude_m);

// Returns the standing objects of object_map.csv, each from the time when it was first seen. Moving
// objects are left out, as their place after the last sighting is unknown. Throws InputError when
// the text is not valid. 'file': its name, for the error.
std::vector<MapEntry> StandingObjects(const std::string& map_csv, const std::string& file);

}  // namespace kestrel
