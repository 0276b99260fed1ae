// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/mapping/object_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Cholesky>

#include "kestrel/base/options.h"

namespace kestrel {
namespace {

// A pair that cannot be: dearer than any sum of possible ones.
constexpr double kMinProbability = 1e-6;

double LogOdds(double probability) { return std::log(probability / (1 - probability)); }

bool IsUsable(const ObjectMeasurement& measurement) {
  return measurement.position.allFinite() && measurement.covariance.allFinite() &&
         measurement.covariance.llt().info() == Eigen::Success;
}

using Observation = Eigen::Matrix<double, 3, MappedObject::kStateSize>;

// From the state to where the object is 'delay_s' after the state's time: a moment.
Observation ObservationAfter(double delay_s) {
  Observation observation = Observation::Zero();
  observation.leftCols<3>().setIdentity();
  observation.middleCols<3>(3).diagonal().setConstant(delay_s);
  return observation;
}

// Adds the logarithms of 'probabilities', and keeps the greatest sum at 0.
template <class Array>
void AddLogarithms(const Array& probabilities, Array* sums) {
  for (std::size_t i = 0; i < sums->size(); ++i) {
    (*sums)[i] += std::log(std::max(probabilities[i], kMinProbability));
  }
  const double best = *std::max_element(sums->begin(), sums->end());
  for (double& sum : *sums) sum -= best;
}

// How likely both have the same colour: -log of the sum of products of probabilities.
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

std::vector<std::string> ObjectMapOptions::Validate() const {
  std::vector<std::string> violations;
  const auto require = [&](bool holds, const char* rule) {
    if (!holds) violations.emplace_back(rule);
  };
  const auto is_share = [](double x) { return x > 0 && x < 1; };
  require(gate > 0, "gate must be positive");
  require(new_density > 0, "new_density must be positive");
  require(min_separation_m >= 0, "min_separation_m must not be negative");
  require(drift_noise >= 0, "drift_noise must not be negative");
  require(acceleration_sigma_mps2 > 0, "acceleration_sigma_mps2 must be positive");
  require(acceleration_time_s >= 0.01, "acceleration_time_s must be at least 0.01");
  require(velocity_time_s >= 0.01, "velocity_time_s must be at least 0.01");
  require(start_speed_sigma_mps > 0, "start_speed_sigma_mps must be positive");
  require(shared_sigma_m >= 0, "shared_sigma_m must not be negative");
  require(is_share(detection_probability), "detection_probability must be in 0 to 1");
  require(is_share(false_probability) && false_probability < detection_probability,
          "false_probability must be positive and below detection_probability");
  require(max_probability > 0.5 && max_probability < 1, "max_probability must be in 0.5 to 1");
  require(removal_probability > 0 && removal_probability < 0.5,
          "removal_probability must be in 0 to 0.5");
  require(confirm_count >= 1, "confirm_count must be at least 1");
  require(capacity >= 1 && capacity <= 4096, "capacity must be in 1 to 4096");
  return violations;
}

ObjectMap::ObjectMap(const ObjectModel& model, const ObjectMapOptions& options)
    : model_(model),
      options_(Checked(options)),
      hit_log_odds_(std::log(options.detection_probability / options.false_probability)),
      miss_log_odds_(
          std::log((1 - options.detection_probability) / (1 - options.false_probability))),
      new_cost_(-2 * std::log(options.new_density)),
      max_log_odds_(LogOdds(options.max_probability)),
      removal_log_odds_(LogOdds(options.removal_probability)) {
  const auto capacity = static_cast<std::size_t>(options.capacity);
  objects_.reserve(capacity + kMaxMeasurements);
  predicted_.reserve(capacity + kMaxMeasurements);
  measurements_.reserve(kMaxMeasurements);
  costs_.resize(kMaxMeasurements, static_cast<Eigen::Index>(capacity + kMaxMeasurements));
}

void ObjectMap::Update(Time time, std::span<const ObjectMeasurement> measurements,
                       const FieldOfView& view) {
  if (time < last_time_) return;
  last_time_ = time;
  measurements_.clear();
  for (const ObjectMeasurement& measurement : measurements) {
    if (measurements_.size() == kMaxMeasurements) break;
    if (IsUsable(measurement)) measurements_.push_back(measurement);
  }
  predicted_ = objects_;
  for (MappedObject& object : predicted_) PredictObject(time, options_.motion(), &object);
  Assign(time);
  FadeUnseen(time, view);
  UnifyNeighbors();
  RemoveSurplus();
}

std::vector<MappedObject> ObjectMap::Confirmed() const {
  std::vector<MappedObject> confirmed;
  for (const MappedObject& object : objects_) {
    if (object.detections >= options_.confirm_count && object.log_odds > 0) {
      confirmed.push_back(object);
    }
  }
  std::sort(confirmed.begin(), confirmed.end(),
            [](const MappedObject& a, const MappedObject& b) { return a.id < b.id; });
  return confirmed;
}

double ObjectMap::Cost(const ObjectMeasurement& measurement, const MappedObject& object) const {
  if (measurement.shape != object.shape) return kImpossibleCost;
  const Observation observation = ObservationAfter(measurement.delay_s);
  Eigen::Matrix3d covariance =
      observation * object.covariance * observation.transpose() + measurement.covariance;
  covariance.diagonal().array() += options_.shared_sigma_m * options_.shared_sigma_m;
  const Eigen::LLT<Eigen::Matrix3d> llt(covariance);
  const Eigen::Vector3d whitened =
      llt.matrixL().solve(measurement.position - observation * object.state);
  const double distance = whitened.squaredNorm();
  if (distance > options_.gate) return kImpossibleCost;
  // -2 log of the likelihood.
  return distance + 3 * std::log(2 * std::numbers::pi) +
         2 * llt.matrixL().nestedExpression().diagonal().array().log().sum() +
         2 * ColorCost(measurement.color_probabilities, object.color_log_likelihoods);
}

void ObjectMap::Fuse(const ObjectMeasurement& measurement, MappedObject* object) const {
  const Observation observation = ObservationAfter(measurement.delay_s);
  const Observation seen = observation * object->covariance;
  const Eigen::Matrix3d innovation = seen * observation.transpose() + measurement.covariance;
  const Eigen::Matrix<double, MappedObject::kStateSize, 3> gain =
      innovation.llt().solve(seen).transpose();
  object->state += (gain * (measurement.position - observation * object->state)).eval();
  // Joseph's form stays symmetric and positive.
  const MappedObject::Covariance rest = MappedObject::Covariance::Identity() - gain * observation;
  object->covariance = rest * object->covariance * rest.transpose() +
                       gain * measurement.covariance * gain.transpose();
  object->color = measurement.color;
  AddLogarithms(measurement.color_probabilities, &object->color_log_likelihoods);
  if (measurement.digits) AddLogarithms(*measurement.digits, &object->digit_log_likelihoods);
  object->log_odds = std::min(max_log_odds_, object->log_odds + hit_log_odds_);
  object->last_seen = object->time;
  ++object->detections;
}

MappedObject ObjectMap::Start(Time time, const ObjectMeasurement& measurement) {
  MappedObject object;
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
    const Eigen::Vector3d axes(1, 1, kClimb);
    Eigen::Matrix<double, 6, 1> sigmas;  // of velocity and acceleration
    sigmas << options_.start_speed_sigma_mps * axes, options_.acceleration_sigma_mps2 * axes;
    object.covariance.bottomRightCorner<6, 6>().diagonal() = sigmas.cwiseAbs2();
    // As fast as it may be, it was as far from there at the time of the frame.
    MappedObject::Covariance back = MappedObject::Covariance::Identity();
    back.topRows<3>() = ObservationAfter(-measurement.delay_s);
    object.covariance = (back * object.covariance * back.transpose()).eval();
  }
  return object;
}

void ObjectMap::Assign(Time time) {
  const auto rows = static_cast<Eigen::Index>(measurements_.size());
  const auto known = static_cast<Eigen::Index>(objects_.size());
  if (rows == 0) return;
  // One column for each object, and one of its own for each detection that is of none.
  auto costs = costs_.topLeftCorner(rows, known + rows);
  costs.rightCols(rows).setConstant(kImpossibleCost);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index k = 0; k < known; ++k) costs(i, k) = Cost(measurements_[i], predicted_[k]);
    costs(i, known + i) = new_cost_;
  }
  const std::vector<int>& columns = solver_.Solve(costs);
  for (Eigen::Index i = 0; i < rows; ++i) {
    if (columns[i] < known) {
      MappedObject& object = objects_[columns[i]];
      object = predicted_[columns[i]];
      Fuse(measurements_[i], &object);
    } else {
      objects_.push_back(Start(time, measurements_[i]));
    }
  }
}

void ObjectMap::FadeUnseen(Time time, const FieldOfView& view) {
  for (std::size_t i = 0; i < predicted_.size(); ++i) {
    if (objects_[i].last_seen != time && view.Shows(predicted_[i])) {
      objects_[i].log_odds += miss_log_odds_;
    }
  }
  std::erase_if(objects_,
                [&](const MappedObject& object) { return object.log_odds < removal_log_odds_; });
}

void ObjectMap::UnifyNeighbors() {
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    for (std::size_t k = objects_.size() - 1; k > i; --k) {
      MappedObject& kept = objects_[i];
      const MappedObject& other = objects_[k];
      if (kept.shape != other.shape || kept.color_index() != other.color_index() ||
          (kept.position() - other.position()).norm() >= options_.min_separation_m) {
        continue;
      }
      UnifyObjects(other, &kept);
      objects_.erase(objects_.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }
}

void ObjectMap::RemoveSurplus() {
  while (objects_.size() > static_cast<std::size_t>(options_.capacity)) {
    const auto is_less_sure = [](const MappedObject& a, const MappedObject& b) {
      return std::pair(a.log_odds, a.last_seen) < std::pair(b.log_odds, b.last_seen);
    };
    objects_.erase(std::min_element(objects_.begin(), objects_.end(), is_less_sure));
  }
}

}  // namespace kestrel
