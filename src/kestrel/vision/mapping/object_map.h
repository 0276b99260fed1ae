// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/vision/mapping/mapped_object.h"

namespace kestrel {

struct ObjectMapOptions {
  // Squared Mahalanobis distance beyond which a detection does not belong to an object. One true
  // detection in a thousand exceeds 16.3 (3 degrees of freedom).
  double gate = 16.3;
  // Density of objects that are not in the map yet, 1/m^3. It makes a detection rather a new object
  // than an old one whose position is no longer known.
  double new_density = 0.005;
  // Two objects of one shape and colour cannot be nearer than this; they are merged.
  double min_separation_m = 0.2;
  // Growth of a standing object's position error; acceleration of a moving object, and the times
  // for which it keeps its acceleration and its velocity.
  double drift_noise = 0.005;
  double acceleration_sigma_mps2 = 0.2;
  double acceleration_time_s = 2;
  double velocity_time_s = 30;
  double start_speed_sigma_mps = 1.5;
  // Errors that look like motion: an error (per axis) that detections at one time share and that
  // wanders over wander_time_s (the navigation's), and an error of the clock offset.
  double wander_sigma_m = 0.05;
  double wander_time_s = 3;
  double clock_sigma_s = 0.03;
  // Probability from which on an object is reported as moving.
  double moving_probability = 0.99;
  // Position error per axis that many detections in a row share (bias of the navigation, clock): no
  // object is known better than this.
  double shared_sigma_m = 0.02;
  // Evidence of a detection and of a miss: the probability that an object in view is detected, and
  // that of a detection without an object. An object is removed at 'removal_probability'.
  double detection_probability = 0.6;
  double false_probability = 0.02;
  double max_probability = 0.999;
  double removal_probability = 0.05;
  // Number of detections after which an object is part of the map.
  int confirm_count = 3;
  // Largest number of objects; the least certain are removed.
  int capacity = 256;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("gate", self.gate, "1",
            "largest squared Mahalanobis distance of a detection that belongs to an object");
    visitor("new_density", self.new_density, "1/m^3",
            "density of objects that are not in the map yet");
    visitor("min_separation_m", self.min_separation_m, "m",
            "distance below which two objects of one kind are merged");
    visitor("drift_noise", self.drift_noise, "m/sqrt(s)",
            "growth of the position error of standing objects");
    visitor("acceleration_sigma_mps2", self.acceleration_sigma_mps2, "m/s^2",
            "acceleration of moving objects, standard deviation per axis");
    visitor("acceleration_time_s", self.acceleration_time_s, "s",
            "typical duration of an acceleration");
    visitor("velocity_time_s", self.velocity_time_s, "s", "typical duration of a velocity");
    visitor("start_speed_sigma_mps", self.start_speed_sigma_mps, "m/s",
            "speed of a new object that may move, standard deviation per axis");
    visitor("wander_sigma_m", self.wander_sigma_m, "m",
            "slowly changing error that detections share, standard deviation per axis");
    visitor("wander_time_s", self.wander_time_s, "s", "typical duration of that error");
    visitor("clock_sigma_s", self.clock_sigma_s, "s",
            "error of the clock offset, standard deviation");
    visitor("moving_probability", self.moving_probability, "1",
            "probability of motion from which on an object is reported as moving");
    visitor("shared_sigma_m", self.shared_sigma_m, "m",
            "error that consecutive detections share, standard deviation per axis");
    visitor("detection_probability", self.detection_probability, "1",
            "probability that an object in view is detected");
    visitor("false_probability", self.false_probability, "1",
            "probability of a detection where there is no object");
    visitor("max_probability", self.max_probability, "1",
            "largest probability that an object exists");
    visitor("removal_probability", self.removal_probability, "1",
            "probability of existence below which an object is removed");
    visitor("confirm_count", self.confirm_count, "1",
            "number of detections that confirm an object");
    visitor("capacity", self.capacity, "1", "largest number of objects that are kept");
  }
  std::vector<std::string> Validate() const;

  ObjectMotion motion() const;
};

// Decides whether an object should have been seen.
class FieldOfView {
 public:
  virtual ~FieldOfView() = default;
  virtual bool Shows(const MappedObject& object) const = 0;
};

// Maps the objects from their detections in the world: the paper's section 3.7 with covariances.
// The detections of a frame are assigned to the objects together, at the least total cost
// (Mahalanobis distance and similarity of colours). A Kalman filter fuses them, a MotionFilter for
// objects that may move. An object that should be seen and is not becomes less certain and is
// finally removed. Bounded memory and time per update.
class ObjectMap {
 public:
  // Throws InputError when the options are invalid. 'model' says which objects may move.
  ObjectMap(const ObjectModel& model, const ObjectMapOptions& options);
  ~ObjectMap();
  ObjectMap(ObjectMap&&) noexcept;
  ObjectMap& operator=(ObjectMap&&) noexcept;

  // Adds the detections of one frame at 'time'. Times must not decrease: an older frame is ignored.
  // Detections that are not finite are ignored, and so are those beyond kMaxMeasurements.
  void Update(Time time, std::span<const ObjectMeasurement> measurements, const FieldOfView& view);

  // Returns the objects that were seen often enough, ordered by id, each at the time when it was
  // last seen. PredictObject predicts where a moving object is since then.
  std::vector<MappedObject> Confirmed() const;

  // Returns all objects, including those that were seen only once.
  std::vector<MappedObject> objects() const;

  static constexpr std::size_t kMaxMeasurements = 64;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kestrel
