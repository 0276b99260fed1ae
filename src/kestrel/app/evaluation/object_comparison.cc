// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/object_comparison.h"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <string_view>

#include "kestrel/app/evaluation/matching.h"
#include "kestrel/app/evaluation/projected_circle.h"

namespace kestrel {
namespace {

constexpr double kMinWantedArea_px = 50;
constexpr double kMinReach_px = 5;
constexpr double kMaxMapDistance_m = 1;
constexpr int kMinSightings = 3;
constexpr std::string_view kMerged = "merged";

// The elements of 'rows', which are in order of time, with this time.
template <class Row>
std::span<const Row> RowsAt(const std::vector<Row>& rows, Time time) {
  const auto begin = std::partition_point(rows.begin(), rows.end(),
                                          [&](const Row& row) { return row.time < time; });
  const auto end =
      std::partition_point(begin, rows.end(), [&](const Row& row) { return row.time == time; });
  return {begin, end};
}

// The object lies flat: its circle is horizontal.
bool IsWanted(const FlightTruth& flight, const TrueSighting& sighting, double diameter_m) {
  const auto world_from_camera = flight.WorldFromCamera(sighting.time);
  if (!world_from_camera || sighting.visible_fraction < 0.999) return false;
  const RigidTransform world_from_object{Eigen::Quaterniond::Identity(),
                                         sighting.position_in_world};
  return ProjectedArea(flight.camera(), world_from_camera->Inverse() * world_from_object,
                       diameter_m) >= kMinWantedArea_px;
}

void MeasureErrors(const FlightTruth& flight, const TrueSighting& truth, const ObjectRow& detected,
                   ObjectComparison* comparison) {
  comparison->center_error_px = (detected.center_px - truth.center_px).norm();
  const auto world_from_camera = flight.WorldFromCamera(truth.time);
  if (world_from_camera && detected.center_in_camera) {
    const double distance = (truth.position_in_world - world_from_camera->translation).norm();
    comparison->depth_error = detected.center_in_camera->norm() / distance - 1;
  }
  if (detected.center_in_world) {
    comparison->world_error_m = (*detected.center_in_world - truth.position_in_world).norm();
  }
}

double ReachOf(const ObjectRow& detection) {
  return std::max(kMinReach_px, detection.semi_major_px);
}

// Touching discs have no position. A row that reports them where they are is neither right nor
// wrong.
bool IsOfTouchingDiscs(const ObjectRow& detection, const TrueObjects& objects,
                       std::span<const TrueSighting> sightings) {
  constexpr int kMinDiscs = 2;
  if (detection.shape != kMerged) return false;
  const auto discs = std::ranges::count_if(sightings, [&](const TrueSighting& sighting) {
    const TrueObject& object = objects.at(sighting.id);
    return object.shape == "disc" && object.class_name == detection.class_name &&
           (sighting.center_px - detection.center_px).norm() <= ReachOf(detection);
  });
  return discs >= kMinDiscs;
}

void SetDetection(const ObjectRow& detection, ObjectComparison* comparison) {
  comparison->detected_class = detection.class_name;
  comparison->detected_shape = detection.shape;
  comparison->class_probability = detection.class_probability;
  comparison->digit = detection.digit;
}

std::vector<Candidate> NearDetections(std::span<const TrueSighting> sightings,
                                      std::span<const ObjectRow> detections) {
  std::vector<Candidate> candidates;
  for (int i = 0; i < static_cast<int>(sightings.size()); ++i) {
    for (int k = 0; k < static_cast<int>(detections.size()); ++k) {
      if (detections[k].shape == kMerged) continue;
      const double distance = (detections[k].center_px - sightings[i].center_px).norm();
      if (distance <= ReachOf(detections[k])) candidates.push_back({i, k, distance});
    }
  }
  return candidates;
}

void CompareFrame(const FlightTruth& flight, const TrueObjects& objects, Time time,
                  std::span<const TrueSighting> sightings, std::span<const ObjectRow> rows,
                  std::vector<ObjectComparison>* comparisons) {
  const std::size_t first = comparisons->size();
  for (const TrueSighting& sighting : sightings) {
    const TrueObject& object = objects.at(sighting.id);
    ObjectComparison& comparison = comparisons->emplace_back();
    comparison.time = time;
    comparison.true_id = sighting.id;
    comparison.true_class = object.class_name;
    comparison.true_shape = object.shape;
    comparison.true_digit = object.digit;
    comparison.is_wanted = IsWanted(flight, sighting, object.diameter_m);
  }
  std::vector<ObjectRow> detections(rows.begin(), rows.end());
  std::erase_if(detections, [&](const ObjectRow& detection) {
    return IsOfTouchingDiscs(detection, objects, sightings);
  });
  std::set<int> matched;
  for (const Candidate& match : MatchNearest(NearDetections(sightings, detections))) {
    ObjectComparison& comparison = (*comparisons)[first + match.first];
    SetDetection(detections[match.second], &comparison);
    MeasureErrors(flight, sightings[match.first], detections[match.second], &comparison);
    matched.insert(match.second);
  }
  for (int k = 0; k < static_cast<int>(detections.size()); ++k) {
    if (matched.contains(k)) continue;
    ObjectComparison& comparison = comparisons->emplace_back();
    comparison.time = time;
    SetDetection(detections[k], &comparison);
  }
}

}  // namespace

bool LooksAlike(int digit, int other) {
  const auto upright = [](int x) { return x == 9 ? 6 : x; };
  return upright(digit) == upright(other);
}

std::vector<ObjectComparison> CompareObjects(const FlightTruth& flight, const TrueObjects& objects,
                                             const std::vector<TrueSighting>& sightings,
                                             const ObjectRows& rows, const std::string& file) {
  std::vector<ObjectComparison> comparisons;
  for (const Time time : rows.frames) {
    flight.RequireFrame(time, file);
    CompareFrame(flight, objects, time, RowsAt(sightings, time), RowsAt(rows.objects, time),
                 &comparisons);
  }
  return comparisons;
}

std::set<int> WantedObjects(const std::vector<ObjectComparison>& comparisons) {
  std::map<int, int> wanted_sightings;
  for (const ObjectComparison& comparison : comparisons) {
    if (comparison.is_wanted) ++wanted_sightings[*comparison.true_id];
  }
  std::set<int> wanted;
  for (const auto& [id, count] : wanted_sightings) {
    if (count >= kMinSightings) wanted.insert(id);
  }
  return wanted;
}

std::vector<MapComparison> CompareMap(const TrueObjects& objects,
                                      const std::vector<TrueSighting>& sightings,
                                      const std::vector<ObjectComparison>& comparisons,
                                      const std::vector<MapRow>& rows) {
  std::set<int> wanted = WantedObjects(comparisons);
  std::vector<Candidate> candidates;
  for (const auto& [id, object] : objects) {
    for (int k = 0; k < static_cast<int>(rows.size()); ++k) {
      const TrueSighting* truth = NearestSighting(sightings, id, rows[k].last_seen);
      if (!truth) continue;
      const double distance =
          (rows[k].position_in_world - PositionAt(*truth, rows[k].last_seen)).norm();
      if (distance <= kMaxMapDistance_m) candidates.push_back({id, k, distance});
    }
  }
  std::vector<MapComparison> map;
  std::set<int> matched;
  for (const Candidate& match : MatchNearest(candidates)) {
    const MapRow& row = rows[match.second];
    const TrueSighting* truth = NearestSighting(sightings, match.first, row.last_seen);
    const TrueObject& object = objects.at(match.first);
    map.push_back({object.class_name,
                   row.class_name,
                   row.shape == object.shape,
                   {},
                   match.distance,
                   (row.velocity_in_world - truth->velocity_in_world).norm()});
    if (object.digit) {
      map.back().is_digit_right = row.digit && LooksAlike(row.digit->digit, *object.digit);
    }
    wanted.erase(match.first);
    matched.insert(match.second);
  }
  for (const int id : wanted) map.push_back({objects.at(id).class_name, "", false, {}, 0, 0});
  for (int k = 0; k < static_cast<int>(rows.size()); ++k) {
    if (!matched.contains(k)) map.push_back({"", rows[k].class_name, false, {}, 0, 0});
  }
  return map;
}

}  // namespace kestrel
