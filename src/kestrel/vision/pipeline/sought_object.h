// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/vision/mapping/object_map.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/tracking/target_tracker.h"

namespace kestrel {

// A detection in the world (m, m^2).
struct ObjectSighting {
  Time time;
  std::size_t class_index = 0;  // in the model's classes
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

// The object to which a UAV goes: the one with the highest score among those of a class in the map.
// While it is seen, a track of its own has its place, which follows it faster than the map does;
// else it is where the map expects it. It stays the same one until both have lost it. Update does
// not allocate.
class SoughtObject {
 public:
  // 'name': of a class of the model, or of several. 'map': the options of the map. Throws
  // InputError when the model has no such class.
  SoughtObject(const ObjectModel& model, const std::string& name, const ObjectMapOptions& map);

  // Takes the sightings of a frame at 'time', and the map with them.
  void Update(Time time, std::span<const ObjectSighting> sightings, const ObjectMap& map);

  // Number of the object, from 1; 0: none was found yet, or it is lost.
  int number() const { return static_cast<int>(id_); }
  std::size_t class_index() const { return class_index_; }  // of the object
  // The object at a time from the last update on; nothing while there is none.
  std::optional<TargetEstimate> At(Time time) const;
  TrackState StateAt(Time time) const;
  // The newest sighting of the object.
  std::optional<Time> seen() const { return seen_; }

 private:
  bool IsSought(std::optional<std::size_t> class_index) const;
  bool IsTracked(Time time) const;
  void Choose(Time time, const ObjectMap& map);
  void Track(Time time, std::span<const ObjectSighting> sightings);

  ObjectModel model_;
  std::string name_;
  ObjectMotion motion_;
  TargetTracker no_track_;  // without measurements
  TargetTracker tracker_;
  std::int64_t id_ = 0;  // in the map; 0: none
  std::size_t class_index_ = 0;
  std::optional<MappedObject> mapped_;  // the object as the map has it; nothing: not any more
  std::optional<Time> seen_;
};

}  // namespace kestrel
