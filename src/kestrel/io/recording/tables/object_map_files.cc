// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/tables/object_map_files.h"

#include "kestrel/core/base/write_file.h"
#include "kestrel/io/recording/tables/object_map_csv.h"
#include "kestrel/vision/mapping/map_file.h"

namespace kestrel {

void WriteObjectMap(const HuntPipeline& pipeline, const std::vector<double>& origin,
                    const OutputFolder& folder) {
  const ObjectModel& model = pipeline.detector().model();
  const std::vector<MappedObject> objects = pipeline.map().Confirmed();
  WriteFile(folder.NewFile("object_map.csv").string(), ObjectMapCsv(objects, model));
  WriteFile(folder.NewFile("object_map.json").string(), PrintObjects(objects));
  if (origin.empty()) return;
  WriteFile(folder.NewFile("object_map.geojson").string(),
            PrintGeoJson(objects, model, {origin[0], origin[1]}));
}

void WriteTeamMap(const std::vector<TeamObject>& common, const std::vector<MappedObject>& own,
                  const ObjectModel& model, const std::vector<double>& origin,
                  const OutputFolder& folder) {
  WriteFile(folder.NewFile("team_map.csv").string(), TeamMapCsv(common, model));
  if (origin.empty()) return;
  WriteFile(folder.NewFile("team_map.geojson").string(),
            PrintGeoJson(own, model, {origin[0], origin[1]}));
}

}  // namespace kestrel
