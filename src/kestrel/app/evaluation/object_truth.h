// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"

namespace kestrel {

// A row of objects0/objects.csv, with its digit from objects0/digits.csv.
struct TrueObject {
  std::string class_name;
  double diameter_m = 0;
  std::string shape;  // disc, cuboid, bar
  std::optional<int> digit;
};
using TrueObjects = std::map<int, TrueObject>;  // by id

// A row of objects0/data.csv: an object in view of an image.
struct TrueSighting {
  Time time;
  int id = 0;
  Eigen::Vector3d position_in_world;
  Eigen::Vector3d velocity_in_world;
  Eigen::Vector2d center_px;
  double visible_fraction = 0;
};

// Throw InputError with file and line for what is not valid. Sightings are in order of time, and
// their ids must be among 'objects'.
TrueObjects ParseTrueObjects(std::string_view text, const std::string& file);
void ParseTrueDigits(std::string_view text, const std::string& file, TrueObjects* objects);
std::vector<TrueSighting> ParseTrueSightings(std::string_view text, const std::string& file,
                                             const TrueObjects& objects);

// The content of objects0 of a recording.
struct ObjectTruth {
  TrueObjects objects;
  std::vector<TrueSighting> sightings;
};
// 'root': the folder of objects0. Throws InputError as above, and for a missing file other than
// digits.csv.
ObjectTruth ReadObjectTruth(const std::string& root);

// Returns the object's sighting nearest to 'time'; null when it was never in view.
const TrueSighting* NearestSighting(const std::vector<TrueSighting>& sightings, int id, Time time);

// Returns the object's position at another time, if its velocity is constant.
Eigen::Vector3d PositionAt(const TrueSighting& sighting, Time time);

}  // namespace kestrel
