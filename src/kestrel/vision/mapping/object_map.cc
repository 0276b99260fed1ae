// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/mapping/object_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include <Eigen/Cholesky>

#include "kestrel/core/base/options.h"
#include "kestrel/vision/mapping/assignment.h"
#include "kestrel/vision/mapping/motion_filter.h"

namespace kestrel {
namespace {

// Least probability, which bounds logarithms.
constexpr double kMinProbability = 1e-6;

double LogOdds(double probability) { return std::log(probability / (1 - probability)); }

bool IsUsable(const ObjectMeasurement& measurement) {
  return measurement.position.allFinite() && measurement.covariance.allFinite() &&
         measurement.clock_shift.allFinite() &&
         measurement.covariance.llt().info() == Eigen::Success;
}

// Adds the logarithms of 'probabilities', and shifts the sums so that the greatest is 0.
template <class Array>
void AddLogarithms(const Array& probabilities, Array* sums) {
  for (std::size_t i = 0; i < sums->size(); ++i) {
    (*sums)[i] += std::log(std::max(probabilities[i], kMinProbability));
  }
  const double best = *std::max_element(sums->begin(), sums->end());
  for (double& sum : *sums) sum -= best;
}

Eigen::Matrix3d PositionCovariance(const MappedObject& object) {
  return object.covariance.topLeftCorner<3, 3>();
}

// Kalman update of a position alone.
void FuseStanding(const ObjectMeasurement& measurement, MappedObject* object) {
  const Eigen::Matrix3d covariance = PositionCovariance(*object);
  const Eigen::Matrix3d innovation = covariance + measurement.covariance;
  const Eigen::Matrix3d gain = innovation.llt().solve(covariance).transpose();
  object->state.head<3>() += (gain * (measurement.position - object->position())).eval();
  // Joseph's form keeps the covariance symmetric and positive.
  const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity() - gain;
  object->covariance.topLeftCorner<3, 3>() =
      rest * covariance * rest.transpose() + gain * measurement.covariance * gain.transpose();
}

// Returns -log of the probability that both have the same colour: the sum of products.
double ColorCost(const ColorProbabilities& probabilities, const ColorProbabilities& logs) {
  double same = 0;
  double total = 0;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    same += probabilities[i] * std::exp(logs[i]);
    total += std::exp(logs[i]);
  }
  return -std::log(std::max(same / total, kMinProbability));
}

}  // namespace

ObjectMotion ObjectMapOptions::motion() const {
  return {kDriftNoise,     kAccelerationSigma_mps2, kAccelerationTime_s,
          kVelocityTime_s, kStartSpeedSigma_mps,    wander_sigma_m,
          kWanderTime_s,   clock_sigma_s,           LogOdds(moving_probability)};
}

class ObjectMap::Impl {
 public:
  Impl(const ObjectModel& model, const ObjectMapOptions& options);

  void Update(Time time, std::span<const ObjectMeasurement> measurements, const FieldOfView& view);
  void VisitConfirmed(const std::function<void(const MappedObject&)>& visit) const;
  std::vector<MappedObject> Confirmed() const;
  std::vector<MappedObject> objects() const;

 private:
  // An object and, if it may move, its motion filter.
  struct Entry {
    MappedObject object;
    MotionFilter motion;
  };

  void Predict(Time time, Entry* entry) const;
  double Cost(const ObjectMeasurement& measurement, const Entry& entry) const;
  void Fuse(const ObjectMeasurement& measurement, Entry* entry) const;
  Entry Start(Time time, const ObjectMeasurement& measurement);
  void Assign(Time time);
  void FadeUnseen(Time time, const FieldOfView& view);
  void UnifyNeighbors();
  void RemoveSurplus();

  ObjectModel model_;
  ObjectMapOptions options_;
  double hit_log_odds_;
  double miss_log_odds_;
  double new_cost_;  // -2 log of the likelihood that a detection is of a new object
  double max_log_odds_;
  double removal_log_odds_;
  ObjectMotion motion_;
  std::vector<Entry> entries_;
  std::vector<Entry> predicted_;  // the entries at the time of the update
  std::vector<ObjectMeasurement> measurements_;
  Eigen::MatrixXd costs_;
  AssignmentSolver solver_;
  std::int64_t next_id_ = 1;
  Time last_time_ = Time::min();
};

ObjectMap::Impl::Impl(const ObjectModel& model, const ObjectMapOptions& options)
    : model_(model),
      options_(Checked(options)),
      hit_log_odds_(
          std::log(ObjectMapOptions::kDetectionProbability / ObjectMapOptions::kFalseProbability)),
      miss_log_odds_(std::log((1 - ObjectMapOptions::kDetectionProbability) /
                              (1 - ObjectMapOptions::kFalseProbability))),
      new_cost_(-2 * std::log(ObjectMapOptions::kNewDensity)),
      max_log_odds_(LogOdds(ObjectMapOptions::kMaxProbability)),
      removal_log_odds_(LogOdds(options.removal_probability)),
      motion_(options.motion()) {
  const auto capacity = static_cast<std::size_t>(options.capacity);
  entries_.reserve(capacity + kMaxMeasurements);
  predicted_.reserve(capacity + kMaxMeasurements);
  measurements_.reserve(kMaxMeasurements);
  costs_.resize(kMaxMeasurements, static_cast<Eigen::Index>(capacity + kMaxMeasurements));
}

void ObjectMap::Impl::Update(Time time, std::span<const ObjectMeasurement> measurements,
                             const FieldOfView& view) {
  if (time < last_time_) return;
  last_time_ = time;
  measurements_.clear();
  for (const ObjectMeasurement& measurement : measurements) {
    if (measurements_.size() == kMaxMeasurements) break;
    if (IsUsable(measurement)) measurements_.push_back(measurement);
  }
  predicted_ = entries_;
  for (Entry& entry : predicted_) Predict(time, &entry);
  Assign(time);
  FadeUnseen(time, view);
  UnifyNeighbors();
  RemoveSurplus();
}

void ObjectMap::Impl::VisitConfirmed(const std::function<void(const MappedObject&)>& visit) const {
  for (const auto& [object, motion] : entries_) {
    if (object.detections >= options_.confirm_count && object.log_odds > 0) visit(object);
  }
}

std::vector<MappedObject> ObjectMap::Impl::Confirmed() const {
  std::vector<MappedObject> confirmed;
  VisitConfirmed([&](const MappedObject& object) { confirmed.push_back(object); });
  std::sort(confirmed.begin(), confirmed.end(),
            [](const MappedObject& a, const MappedObject& b) { return a.id < b.id; });
  return confirmed;
}

std::vector<MappedObject> ObjectMap::Impl::objects() const {
  std::vector<MappedObject> objects;
  for (const auto& [object, motion] : entries_) objects.push_back(object);
  return objects;
}

void ObjectMap::Impl::Predict(Time time, Entry* entry) const {
  const double dt = ToSeconds(time - entry->object.time);
  if (entry->object.may_move && dt > 0) entry->motion.Predict(dt, motion_);
  PredictObject(time, motion_, &entry->object);
}

double ObjectMap::Impl::Cost(const ObjectMeasurement& measurement, const Entry& entry) const {
  const MappedObject& object = entry.object;
  if (measurement.shape != object.shape) return kImpossibleCost;
  const ExpectedPosition expected =
      object.may_move ? entry.motion.Expect(measurement)
                      : ExpectedPosition{object.position(), PositionCovariance(object)};
  Eigen::Matrix3d covariance = expected.covariance + measurement.covariance;
  covariance.diagonal().array() +=
      ObjectMapOptions::kSharedSigma_m * ObjectMapOptions::kSharedSigma_m;
  const Eigen::LLT<Eigen::Matrix3d> llt(covariance);
  const Eigen::Vector3d whitened = llt.matrixL().solve(measurement.position - expected.position);
  const double distance = whitened.squaredNorm();
  if (distance > ObjectMapOptions::kGate) return kImpossibleCost;
  // -2 log of the likelihood.
  return distance + 3 * std::log(2 * std::numbers::pi) +
         2 * llt.matrixL().nestedExpression().diagonal().array().log().sum() +
         2 * ColorCost(measurement.color_probabilities, object.color_log_likelihoods);
}

void ObjectMap::Impl::Fuse(const ObjectMeasurement& measurement, Entry* entry) const {
  MappedObject* const object = &entry->object;
  if (object->may_move) {
    entry->motion.Fuse(measurement, motion_);
    entry->motion.Publish(object);
  } else {
    FuseStanding(measurement, object);
  }
  object->color = measurement.color;
  AddLogarithms(measurement.color_probabilities, &object->color_log_likelihoods);
  if (measurement.digits) AddLogarithms(*measurement.digits, &object->digit_log_likelihoods);
  object->log_odds = std::min(max_log_odds_, object->log_odds + hit_log_odds_);
  object->last_seen = object->time;
  ++object->detections;
}

ObjectMap::Impl::Entry ObjectMap::Impl::Start(Time time, const ObjectMeasurement& measurement) {
  Entry entry;
  MappedObject& object = entry.object;
  object.id = next_id_++;
  object.shape = measurement.shape;
  object.first_seen = object.last_seen = object.time = time;
  object.state.head<3>() = measurement.position;
  object.covariance.topLeftCorner<3, 3>() = measurement.covariance;
  object.color = measurement.color;
  AddLogarithms(measurement.color_probabilities, &object.color_log_likelihoods);
  if (measurement.digits) AddLogarithms(*measurement.digits, &object.digit_log_likelihoods);
  object.detections = 1;
  const auto index = ClassOf(object, model_);
  object.may_move = index && model_.classes[*index].may_move;
  if (object.may_move) {
    entry.motion = MotionFilter(measurement, motion_);
    entry.motion.Publish(&object);
  }
  return entry;
}

void ObjectMap::Impl::Assign(Time time) {
  const auto rows = static_cast<Eigen::Index>(measurements_.size());
  const auto known = static_cast<Eigen::Index>(entries_.size());
  if (rows == 0) return;
  // One column for each object, and one for each detection that belongs to no object.
  auto costs = costs_.topLeftCorner(rows, known + rows);
  costs.rightCols(rows).setConstant(kImpossibleCost);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index k = 0; k < known; ++k) costs(i, k) = Cost(measurements_[i], predicted_[k]);
    costs(i, known + i) = new_cost_;
  }
  const std::vector<int>& columns = solver_.Solve(costs);
  for (Eigen::Index i = 0; i < rows; ++i) {
    if (columns[i] < known) {
      Entry& entry = entries_[columns[i]];
      entry = predicted_[columns[i]];
      Fuse(measurements_[i], &entry);
    } else {
      entries_.push_back(Start(time, measurements_[i]));
    }
  }
}

void ObjectMap::Impl::FadeUnseen(Time time, const FieldOfView& view) {
  for (std::size_t i = 0; i < predicted_.size(); ++i) {
    MappedObject& object = entries_[i].object;
    if (object.last_seen != time && view.Shows(predicted_[i].object)) {
      object.log_odds += miss_log_odds_;
    }
  }
  std::erase_if(entries_,
                [&](const Entry& entry) { return entry.object.log_odds < removal_log_odds_; });
}

void ObjectMap::Impl::UnifyNeighbors() {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    for (std::size_t k = entries_.size() - 1; k > i; --k) {
      MappedObject& kept = entries_[i].object;
      const MappedObject& other = entries_[k].object;
      if (kept.shape != other.shape || kept.color_index() != other.color_index() ||
          (kept.position() - other.position()).norm() >= ObjectMapOptions::kMinSeparation_m) {
        continue;
      }
      if (other.detections > kept.detections) entries_[i].motion = entries_[k].motion;
      UnifyObjects(other, &kept);
      entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }
}

void ObjectMap::Impl::RemoveSurplus() {
  while (entries_.size() > static_cast<std::size_t>(options_.capacity)) {
    const auto is_less_sure = [](const Entry& a, const Entry& b) {
      return std::pair(a.object.log_odds, a.object.last_seen) <
             std::pair(b.object.log_odds, b.object.last_seen);
    };
    entries_.erase(std::min_element(entries_.begin(), entries_.end(), is_less_sure));
  }
}

ObjectMap::ObjectMap(const ObjectModel& model, const ObjectMapOptions& options)
    : impl_(std::make_unique<Impl>(model, options)) {}
ObjectMap::~ObjectMap() = default;
ObjectMap::ObjectMap(ObjectMap&&) noexcept = default;
ObjectMap& ObjectMap::operator=(ObjectMap&&) noexcept = default;

void ObjectMap::Update(Time time, std::span<const ObjectMeasurement> measurements,
                       const FieldOfView& view) {
  impl_->Update(time, measurements, view);
}
void ObjectMap::VisitConfirmed(const std::function<void(const MappedObject&)>& visit) const {
  impl_->VisitConfirmed(visit);
}
std::vector<MappedObject> ObjectMap::Confirmed() const { return impl_->Confirmed(); }
std::vector<MappedObject> ObjectMap::objects() const { return impl_->objects(); }

}  // namespace kestrel
