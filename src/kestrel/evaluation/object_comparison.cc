// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/evaluation/object_comparison.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <span>

#include "kestrel/evaluation/matching.h"
#include "kestrel/evaluation/projected_circle.h"

namespace kestrel {
namespace {

constexpr double kMinWantedArea_px = 50;
constexpr double kMinReach_px = 5;
constexpr double kMaxMapDistance_m = 1;
constexpr int kMinSightings = 3;

// The elements of 'rows', in order of time, that are of 'time'.
template <class Row>
std::span<const Row> RowsAt(const std::vector<Row>& rows, Time time) {
  const auto begin = std::partition_point(rows.begin(), rows.end(),
                                          [&](const Row& row) { return row.time < time; });
  const auto end =
      std::partition_point(begin, rows.end(), [&](const Row& row) { return row.time == time; });
  return {begin, end};
}

// An object lies flat: its circle is horizontal.
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

// Several objects that touch, or a part of one that the image's border cuts off: without a position
// they are neither right nor wrong.
std::vector<ObjectRow> Located(std::span<const ObjectRow> detections) {
  std::vector<ObjectRow> located;
  std::ranges::copy_if(detections, std::back_inserter(located),
                       [](const ObjectRow& row) { return row.center_in_camera.has_value(); });
  return located;
}

std::vector<Candidate> NearDetections(std::span<const TrueSighting> sightings,
                                      std::span<const ObjectRow> detections) {
  std::vector<Candidate> candidates;
  for (int i = 0; i < static_cast<int>(sightings.size()); ++i) {
    for (int k = 0; k < static_cast<int>(detections.size()); ++k) {
      const double distance = (detections[k].center_px - sightings[i].center_px).norm();
      if (distance <= std::max(kMinReach_px, detections[k].semi_major_px)) {
        candidates.push_back({i, k, distance});
      }
    }
  }
  return candidates;
}

void CompareFrame(const FlightTruth& flight, const TrueObjects& objects, Time time,
                  std::span<const TrueSighting> sightings, std::span<const ObjectRow> detections,
                  std::vector<ObjectComparison>* comparisons) {
  const std::size_t first = comparisons->size();
  for (const TrueSighting& sighting : sightings) {
    const TrueObject& object = objects.at(sighting.id);
    comparisons->push_back({time,
                            sighting.id,
                            object.class_name,
                            "",
                            IsWanted(flight, sighting, object.diameter_m),
                            0,
                            {},
                            {}});
  }
  std::set<int> matched;
  for (const Candidate& match : MatchNearest(NearDetections(sightings, detections))) {
    ObjectComparison& comparison = (*comparisons)[first + match.first];
    comparison.detected_class = detections[match.second].class_name;
    MeasureErrors(flight, sightings[match.first], detections[match.second], &comparison);
    matched.insert(match.second);
  }
  for (int k = 0; k < static_cast<int>(detections.size()); ++k) {
    if (!matched.contains(k)) {
      comparisons->push_back({time, {}, "", detections[k].class_name, false, 0, {}, {}});
    }
  }
}

}  // namespace

std::vector<ObjectComparison> CompareObjects(const FlightTruth& flight, const TrueObjects& objects,
                                             const std::vector<TrueSighting>& sightings,
                                             const ObjectRows& rows, const std::string& file) {
  std::vector<ObjectComparison> comparisons;
  for (const Time time : rows.frames) {
    flight.RequireFrame(time, file);
    CompareFrame(flight, objects, time, RowsAt(sightings, time),
                 Located(RowsAt(rows.objects, time)), &comparisons);
  }
  return comparisons;
}

std::vector<MapComparison> CompareMap(const TrueObjects& objects,
                                      const std::vector<TrueSighting>& sightings,
                                      const std::vector<ObjectComparison>& comparisons,
                                      const std::vector<MapRow>& rows) {
  std::map<int, int> wanted_sightings;
  for (const ObjectComparison& comparison : comparisons) {
    if (comparison.is_wanted) ++wanted_sightings[*comparison.true_id];
  }
  std::set<int> wanted;
  for (const auto& [id, count] : wanted_sightings) {
    if (count >= kMinSightings) wanted.insert(id);
  }
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
    map.push_back({objects.at(match.first).class_name, row.class_name, match.distance,
                   (row.velocity_in_world - truth->velocity_in_world).norm()});
    wanted.erase(match.first);
    matched.insert(match.second);
  }
  for (const int id : wanted) map.push_back({objects.at(id).class_name, "", 0, 0});
  for (int k = 0; k < static_cast<int>(rows.size()); ++k) {
    if (!matched.contains(k)) map.push_back({"", rows[k].class_name, 0, 0});
  }
  return map;
}

}  // namespace kestrel
