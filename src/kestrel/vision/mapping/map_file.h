// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/vision/mapping/mapped_object.h"

namespace kestrel {

// Returns the objects as JSON, without loss, to the last bit.
std::string PrintObjects(const std::vector<MappedObject>& objects);

// Throws InputError, with the line, for truncated text and for values that no map has. 'file' is
// for messages.
std::vector<MappedObject> ParseObjects(const std::string& text, const std::string& file);

// SaveObjects replaces the file atomically; both throw InputError.
void SaveObjects(const std::string& path, const std::vector<MappedObject>& objects);
std::vector<MappedObject> LoadObjects(const std::string& path);

// Origin of the world frame (ENU), WGS 84, degrees.
struct GeoOrigin {
  double latitude_deg = 0;   // -90 to 90, both excluded
  double longitude_deg = 0;  // -180 to 180
};

// Returns a FeatureCollection (RFC 7946) with a point for each object; its class, score, sigma_m
// and velocity are properties. The earth is approximated by its osculating ellipsoid at the origin:
// right to 1 cm within a kilometre.
std::string PrintGeoJson(const std::vector<MappedObject>& objects, const ObjectModel& model,
                         const GeoOrigin& origin);

}  // namespace kestrel
