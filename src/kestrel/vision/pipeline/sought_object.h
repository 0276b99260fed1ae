// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

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

// An object that somebody else has chosen for the UAV.
struct AssignedObject {
  int number = 0;       // each object has another one, from 1; 0: there is none
  std::int64_t id = 0;  // of it in the map; 0: the map does not have it, or not yet
  MappedObject object;  // as far as it is known elsewhere
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

  // From now on seeks what is assigned instead of choosing by itself.
  void Assign(const AssignedObject& object) { assigned_ = object; }
  // The object of this number is not sought any more, although the map may still have it.
  void Leave(int number);

  // Number of the object, from 1; 0: none was found yet, or it is lost.
  int number() const { return number_; }
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
  void TakeAssigned(Time time, const ObjectMap& map);
  void Forget();
  void Track(Time time, std::span<const ObjectSighting> sightings);

  ObjectModel model_;
  std::string name_;
  ObjectMotion motion_;
  TargetTracker no_track_;  // without measurements
  TargetTracker tracker_;
  std::int64_t id_ = 0;  // in the map; 0: none
  int number_ = 0;
  std::optional<AssignedObject> assigned_;  // nothing: chooses by itself
  std::vector<std::int64_t> left_;
  std::size_t class_index_ = 0;
  std::optional<MappedObject> mapped_;  // the object as the map has it; nothing: not any more
  std::optional<Time> seen_;
};

}  // namespace kestrel
