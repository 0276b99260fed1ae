// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/pipeline/hunt_pipeline.h"
#include "kestrel/recording/output_folder.h"

namespace kestrel {

// Writes the confirmed objects of the pipeline's map: object_map.csv, object_map.json (nothing is
// lost), and object_map.geojson where 'origin' is known: latitude and longitude (degrees) of the
// world's origin, or empty. Throws InputError when they cannot be written.
void WriteObjectMap(const HuntPipeline& pipeline, const std::vector<double>& origin,
                    const OutputFolder& folder);

}  // namespace kestrel
