// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "kestrel/app/evaluation/flight_truth.h"
#include "kestrel/app/evaluation/object_results.h"
#include "kestrel/app/evaluation/object_truth.h"

namespace kestrel {

// A detection, an object in view, or a pair of both.
struct ObjectComparison {
  Time time;
  std::optional<int> true_id;  // empty: there is no such object
  std::string true_class;
  std::string true_shape;
  std::optional<int> true_digit;
  bool is_wanted = false;  // wholly in view with at least 50 px: it must be found
  // Values of the detection; the class is empty where there is none.
  std::string detected_class;
  std::string detected_shape;
  double class_probability = 0;
  std::optional<ReportedDigit> digit;
  // Errors of the detection, estimate minus truth.
  double center_error_px = 0;
  std::optional<double> depth_error;  // relative to the distance; positive: too far away
  std::optional<double> world_error_m;

  bool IsObject() const { return true_id.has_value(); }
  bool IsDetected() const { return !detected_class.empty(); }
};

// True when both digits look the same: a 6 upside down is a 9.
bool LooksAlike(int digit, int other);

// Matches each detection with the nearest object in view (of any class) whose centre is at most its
// semi-major axis, or 5 px, away. A merged detection is left out when at least two discs of its
// class are within that distance, and matches nothing otherwise. Frames without a row in 'rows' are
// left out. Throws InputError for a row without an image.
std::vector<ObjectComparison> CompareObjects(const FlightTruth& flight, const TrueObjects& objects,
                                             const std::vector<TrueSighting>& sightings,
                                             const ObjectRows& rows, const std::string& file);

// An entry of the map, an object that should be in the map, or a pair of both.
struct MapComparison {
  std::string true_class;    // empty: there is no such object
  std::string mapped_class;  // empty: it is not in the map
  bool is_shape_right = false;
  std::optional<bool> is_digit_right;  // only for objects with a digit; 6 and 9 count as the same
  double position_error_m = 0;
  double velocity_error_mps = 0;

  bool IsObject() const { return !true_class.empty(); }
  bool IsMapped() const { return !mapped_class.empty(); }
};

// Returns the ids of the objects that should be in the map: those with at least three wanted
// sightings. The UAV only passed the others.
std::set<int> WantedObjects(const std::vector<ObjectComparison>& comparisons);

// Compares the wanted objects with the entries of the map. They are paired where they are at most 1
// m apart at the time when the entry was last seen.
std::vector<MapComparison> CompareMap(const TrueObjects& objects,
                                      const std::vector<TrueSighting>& sightings,
                                      const std::vector<ObjectComparison>& comparisons,
                                      const std::vector<MapRow>& rows);

}  // namespace kestrel
