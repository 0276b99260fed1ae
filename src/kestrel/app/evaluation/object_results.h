// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"

namespace kestrel {

// The digit of a row with its reported probability.
struct ReportedDigit {
  int digit = 0;
  double probability = 0;
};

// A row of object_detections.csv with an object in it.
struct ObjectRow {
  Time time;
  Eigen::Vector2d center_px;
  double semi_major_px = 0;
  std::string class_name;
  double class_probability = 0;
  std::string shape;  // disc, cuboid, bar, merged
  std::optional<ReportedDigit> digit;
  std::optional<Eigen::Vector3d> center_in_camera;  // merged objects have none
  std::optional<Eigen::Vector3d> center_in_world;
};

// The content of object_detections.csv: the objects, and the times of all frames.
struct ObjectRows {
  std::vector<Time> frames;  // increasing
  std::vector<ObjectRow> objects;
};

// A row of object_map.csv.
struct MapRow {
  int id = 0;
  std::string class_name;
  std::string shape;
  std::optional<ReportedDigit> digit;
  Eigen::Vector3d position_in_world;
  Eigen::Vector3d velocity_in_world;
  Time last_seen;
};

// Throw InputError with file and line for what is not valid or not in order, as an object without a
// position.
ObjectRows ParseObjectRows(std::string_view text, const std::string& file);
std::vector<MapRow> ParseMapRows(std::string_view text, const std::string& file);

}  // namespace kestrel
