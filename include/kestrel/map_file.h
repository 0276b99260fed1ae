// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Maps of objects in files: JSON without loss, and GeoJSON for maps on the web.
//
// Example:
//   const std::vector<MappedObject> objects = LoadObjects("object_map.json");
//   const GeoOrigin origin{.latitude_deg = 24.4, .longitude_deg = 54.4};
//   std::ofstream("map.geojson") << PrintGeoJson(objects, DefaultObjectModel(), origin);

#include "kestrel/vision/mapping/map_file.h"  // IWYU pragma: export
