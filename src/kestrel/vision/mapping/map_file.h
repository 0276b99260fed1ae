// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/vision/mapping/mapped_object.h"

namespace kestrel {

// The objects as JSON, to the last bit; nothing of them is lost.
std::string PrintObjects(const std::vector<MappedObject>& objects);

// Throws InputError, with the line, for a text that is cut off or has a value that no map has;
// 'file' is for messages.
std::vector<MappedObject> ParseObjects(const std::string& text, const std::string& file);

// SaveObjects replaces the file atomically; both throw InputError.
void SaveObjects(const std::string& path, const std::vector<MappedObject>& objects);
std::vector<MappedObject> LoadObjects(const std::string& path);

// Where the origin of the world frame (ENU) lies, WGS 84, degrees.
struct GeoOrigin {
  double latitude_deg = 0;   // -90 to 90, both excluded
  double longitude_deg = 0;  // -180 to 180
};

// A FeatureCollection (RFC 7946) with a point for each object and its class, score, sigma_m and
// velocity as properties. The earth is taken for its osculating ellipsoid at the origin: right to
// 1 cm within a kilometre.
std::string PrintGeoJson(const std::vector<MappedObject>& objects, const ObjectModel& model,
                         const GeoOrigin& origin);

}  // namespace kestrel
