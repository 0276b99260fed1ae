// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/sought_object.h"

#include <algorithm>
#include <functional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr std::size_t kMostLeft = 256;

TargetTrackerOptions TrackerOf(const ObjectModel& model, const std::string& name) {
  const bool may_move = std::ranges::any_of(
      model.classes, [&](const ObjectClass& one) { return one.name == name && one.may_move; });
  TargetTrackerOptions options;
  options.acceleration_noise = may_move ? 0.5 : 0.03;
  options.turn_noise = options.start_turn_sigma_radps = 0;  // a robot turns on the spot
  options.sway_sigma_m = 0;
  options.max_speed_mps = 5;
  return options;
}

// Returns the model, which has such a class.
const ObjectModel& WithClass(const ObjectModel& model, const std::string& name) {
  std::vector<std::string> names;
  for (const ObjectClass& one : model.classes) {
    if (one.name == name) return model;
    if (std::ranges::find(names, one.name) == names.end()) names.push_back(one.name);
  }
  throw InputError(fmt::format("the model of the objects has no class '{}', expected {}", name,
                               fmt::join(names, ", ")));
}

TargetEstimate EstimateOf(const MappedObject& object) {
  TargetEstimate estimate;
  estimate.time = object.time;
  estimate.motion.mean.head<6>() = object.state.head<6>();
  estimate.motion.covariance.topLeftCorner<6, 6>() = object.covariance.topLeftCorner<6, 6>();
  return estimate;
}

}  // namespace

SoughtObject::SoughtObject(const ObjectModel& model, const std::string& name,
                           const ObjectMapOptions& map)
    : model_(WithClass(model, name)),
      name_(name),
      motion_(map.motion()),
      no_track_(TrackerOf(model, name)),
      tracker_(TrackerOf(model, name)) {  // a copy would have no room reserved
  left_.reserve(kMostLeft);
}

void SoughtObject::Update(Time time, std::span<const ObjectSighting> sightings,
                          const ObjectMap& map) {
  if (assigned_) {
    TakeAssigned(time, map);
  } else {
    Choose(time, map);
  }
  if (number_ != 0) Track(time, sightings);
}

bool SoughtObject::IsSought(std::optional<std::size_t> class_index) const {
  return class_index && model_.classes[*class_index].name == name_;
}

bool SoughtObject::IsTracked(Time time) const {
  const TrackState state = tracker_.StateAt(time);
  return state == TrackState::kTracking || state == TrackState::kPredicting;
}

void SoughtObject::Choose(Time time, const ObjectMap& map) {
  std::optional<MappedObject> best;
  mapped_.reset();
  const auto choose = [&](MappedObject object) {
    if (!IsSought(ClassOf(object, model_))) return;
    PredictObject(time, motion_, &object);
    if (object.sigma_m() > kMostSoughtSigma_m) return;
    if (std::ranges::find(left_, object.id) != left_.end()) return;
    if (object.id == id_) mapped_ = object;
    if (!best || ScoreOf(object, model_) > ScoreOf(*best, model_)) best = object;
  };
  map.VisitConfirmed(std::ref(choose));  // a reference fits into std::function
  if (id_ != 0 && (mapped_ || IsTracked(time))) return;
  Forget();
  if (!best) return;
  id_ = best->id;
  number_ = static_cast<int>(id_);
  class_index_ = *ClassOf(*best, model_);
  mapped_ = best;
  seen_ = best->last_seen;
}

void SoughtObject::Forget() {
  id_ = number_ = 0;
  tracker_ = no_track_;
  seen_.reset();
}

// The map has an object more precisely than those who have not seen it from here.
void SoughtObject::TakeAssigned(Time time, const ObjectMap& map) {
  if (assigned_->number != number_) Forget();
  number_ = assigned_->number;
  id_ = assigned_->id;
  mapped_.reset();
  if (number_ == 0) return;
  class_index_ = ClassOf(assigned_->object, model_).value_or(0);
  std::optional<Time> seen;
  const auto find = [&](const MappedObject& object) {
    if (object.id != id_) return;
    mapped_ = object;
    seen = object.last_seen;
  };
  map.VisitConfirmed(std::ref(find));
  if (!mapped_) mapped_ = assigned_->object;
  PredictObject(time, motion_, &*mapped_);
  if (mapped_->sigma_m() > kMostSoughtSigma_m) mapped_.reset();
  if (!seen_) seen_ = seen;
}

void SoughtObject::Leave(int number) {
  if (number == 0 || number != number_) return;
  if (!assigned_) {
    if (left_.size() == left_.capacity()) left_.erase(left_.begin());
    left_.push_back(id_);
  }
  Forget();
}

// Takes the nearest sighting, unless another object is as likely there.
void SoughtObject::Track(Time time, std::span<const ObjectSighting> sightings) {
  constexpr double kGate_m = 0.3, kSigmas = 3, kMostGate_m = 1.5;
  const auto expected = At(time);
  if (!expected) return;
  const ObjectSighting* nearest = nullptr;
  double nearest_m = std::min(kGate_m + kSigmas * expected->position_sigma_m(), kMostGate_m);
  for (const ObjectSighting& sighting : sightings) {
    const double off_m = (sighting.position - expected->motion.position()).norm();
    if (!IsSought(sighting.class_index) || off_m > nearest_m) continue;
    nearest = &sighting;
    nearest_m = off_m;
  }
  if (nearest == nullptr) return;
  const MeasurementFate fate = tracker_.Add({.time = nearest->time,
                                             .position_in_world = nearest->position,
                                             .covariance = nearest->covariance});
  if (fate == MeasurementFate::kStarted || fate == MeasurementFate::kAccepted) seen_ = time;
}

std::optional<TargetEstimate> SoughtObject::At(Time time) const {
  if (number_ == 0) return std::nullopt;
  if (IsTracked(time)) return tracker_.Predict(time);
  if (!mapped_) return std::nullopt;
  MappedObject object = *mapped_;
  PredictObject(time, motion_, &object);
  return EstimateOf(object);
}

TrackState SoughtObject::StateAt(Time time) const {
  if (number_ == 0) return TrackState::kSearching;
  return IsTracked(time) ? tracker_.StateAt(time) : TrackState::kPredicting;
}

}  // namespace kestrel
