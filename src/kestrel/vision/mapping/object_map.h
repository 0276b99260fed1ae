// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/time.h"
#include "kestrel/vision/mapping/mapped_object.h"

namespace kestrel {

struct ObjectMapOptions {
  // Squared Mahalanobis distance beyond which a detection does not belong to an object. One true
  // detection in a thousand exceeds it (3 degrees of freedom).
  static constexpr double kGate = 16.3;
  // Density of objects that are not in the map yet, 1/m^3. It makes a detection rather a new object
  // than an old one whose position is no longer known.
  static constexpr double kNewDensity = 0.005;
  // Two objects of one shape and colour cannot be nearer than this; they are merged.
  static constexpr double kMinSeparation_m = 0.2;
  // Growth of a standing object's position error; acceleration of a moving object, and the times
  // for which it keeps its acceleration and its velocity.
  static constexpr double kDriftNoise = 0.005;
  static constexpr double kAccelerationSigma_mps2 = 0.2;
  static constexpr double kAccelerationTime_s = 2;
  static constexpr double kVelocityTime_s = 30;
  static constexpr double kStartSpeedSigma_mps = 1.5;
  static constexpr double kWanderTime_s = 3;  // in which the error of wander_sigma_m changes
  // Position error per axis that many detections in a row share (bias of the navigation, clock): no
  // object is known better than this.
  static constexpr double kSharedSigma_m = 0.02;
  // Evidence of a detection and of a miss: the probability that an object in view is detected, and
  // that of a detection without an object.
  static constexpr double kDetectionProbability = 0.6;
  static constexpr double kFalseProbability = 0.02;
  static constexpr double kMaxProbability = 0.999;

  double wander_sigma_m = 0.05;
  double clock_sigma_s = 0.03;
  double moving_probability = 0.99;
  double removal_probability = 0.05;
  int confirm_count = 3;
  int capacity = 256;

  static void Visit(auto& self, auto&& visit) {
    visit("wander_sigma_m", self.wander_sigma_m, AtLeast(0),
          "slowly changing error that detections share, standard deviation per axis");
    visit("clock_sigma_s", self.clock_sigma_s, AtLeast(0),
          "standard deviation of the clock offset");
    visit("moving_probability", self.moving_probability, Between(0.5, 1),
          "probability of motion from which on an object is reported as moving");
    visit("removal_probability", self.removal_probability, Between(0, 0.5),
          "probability of existence below which an object is removed");
    visit("confirm_count", self.confirm_count, AtLeast(1), "detections that confirm an object");
    visit("capacity", self.capacity, Range{1, 4096}, "largest number of objects that are kept");
    visit.Gone({"gate", "new_density", "min_separation_m", "drift_noise", "acceleration_sigma_mps2",
                "acceleration_time_s", "velocity_time_s", "start_speed_sigma_mps", "wander_time_s",
                "shared_sigma_m", "detection_probability", "false_probability", "max_probability"});
  }

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
  // Throws InputError when the options are invalid. 'model' defines which objects may move.
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

  // Calls 'visit' with each of them, in no order; does not allocate.
  void VisitConfirmed(const std::function<void(const MappedObject&)>& visit) const;

  // Returns all objects, including those that were seen only once.
  std::vector<MappedObject> objects() const;

  static constexpr std::size_t kMaxMeasurements = 64;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kestrel
