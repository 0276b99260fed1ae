// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/io/recording/output_folder.h"
#include "kestrel/vision/mapping/team_object.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// Writes the confirmed objects of the pipeline's map: object_map.csv, object_map.json (which loses
// nothing) and, if 'origin' is not empty, object_map.geojson. 'origin': latitude and longitude
// (degrees) of the world's origin. Throws InputError when they cannot be written.
void WriteObjectMap(const HuntPipeline& pipeline, const std::vector<double>& origin,
                    const OutputFolder& folder);

// Writes the team's map: team_map.csv, in the world frame that the team shares, and, if 'origin' is
// not empty, team_map.geojson with 'own', the same objects in the world frame that has this origin.
// Throws InputError when they cannot be written.
void WriteTeamMap(const std::vector<TeamObject>& common, const std::vector<MappedObject>& own,
                  const ObjectModel& model, const std::vector<double>& origin,
                  const OutputFolder& folder);

}  // namespace kestrel
