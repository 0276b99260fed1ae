// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/mapping/mapped_object.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace kestrel {

double MappedObject::sigma_m() const {
  return std::sqrt(covariance.topLeftCorner<3, 3>().trace() / 3);
}

std::size_t MappedObject::color_index() const {
  const auto best = std::max_element(color_log_likelihoods.begin(), color_log_likelihoods.end());
  return best - color_log_likelihoods.begin();
}

std::optional<int> MappedObject::digit() const {
  if (shape != ObjectShape::kCuboid) return std::nullopt;
  const auto best = std::max_element(digit_log_likelihoods.begin(), digit_log_likelihoods.end());
  return static_cast<int>(best - digit_log_likelihoods.begin());
}

void PredictObject(Time time, const ObjectMotion& motion, MappedObject* object) {
  const double dt = ToSeconds(time - object->time);
  if (!(dt > 0)) return;
  object->time = time;
  if (!object->may_move) {
    object->covariance.topLeftCorner<3, 3>().diagonal().array() +=
        motion.drift_noise * motion.drift_noise * dt;
    return;
  }
  // A velocity that is disturbed by white acceleration and forgotten with time: nothing drives
  // straight on for long (Ornstein-Uhlenbeck process).
  const double t = motion.velocity_time_s;
  const double kept = std::exp(-dt / t);
  const double way = t * (1 - kept);
  MappedObject::Matrix6 transition = MappedObject::Matrix6::Identity();
  transition.topRightCorner<3, 3>().diagonal().setConstant(way);
  transition.bottomRightCorner<3, 3>().diagonal().setConstant(kept);
  const double q = motion.acceleration_noise * motion.acceleration_noise;
  const Eigen::Vector3d density(q, q, kClimb * kClimb * q);
  MappedObject::Matrix6 noise = MappedObject::Matrix6::Zero();
  noise.topLeftCorner<3, 3>().diagonal() = density * t * t * (dt - way - way * way / (2 * t));
  noise.topRightCorner<3, 3>().diagonal() = density * way * way / 2;
  noise.bottomLeftCorner<3, 3>().diagonal() = density * way * way / 2;
  noise.bottomRightCorner<3, 3>().diagonal() = density * t / 2 * (1 - kept * kept);
  object->state = (transition * object->state).eval();
  object->covariance = (transition * object->covariance * transition.transpose() + noise).eval();
}

void UnifyObjects(const MappedObject& other, MappedObject* kept) {
  // A standing object's velocity has no covariance, hence a solver for what is singular.
  const MappedObject::Matrix6 sum = kept->covariance + other.covariance;
  const MappedObject::Matrix6 gain = sum.fullPivLu().solve(kept->covariance).transpose();
  kept->state = (kept->state + gain * (other.state - kept->state)).eval();
  kept->covariance = (kept->covariance - gain * kept->covariance).eval();
  kept->covariance = (0.5 * (kept->covariance + kept->covariance.transpose())).eval();
  kept->first_seen = std::min(kept->first_seen, other.first_seen);
  kept->last_seen = std::max(kept->last_seen, other.last_seen);
  kept->detections += other.detections;
  kept->log_odds = std::max(kept->log_odds, other.log_odds);
  const auto add = [](const auto& from, auto* to) {
    for (std::size_t i = 0; i < to->size(); ++i) (*to)[i] += from[i];
  };
  add(other.color_log_likelihoods, &kept->color_log_likelihoods);
  add(other.digit_log_likelihoods, &kept->digit_log_likelihoods);
}

std::optional<std::size_t> ClassOf(const MappedObject& object, const ObjectModel& model) {
  for (std::size_t i = 0; i < model.classes.size(); ++i) {
    const ObjectClass& c = model.classes[i];
    if (c.shape == object.shape && c.color == object.color_index()) return i;
  }
  return std::nullopt;
}

double ScoreOf(const MappedObject& object, const ObjectModel& model) {
  if (const auto digit = object.digit()) return *digit;
  const auto index = ClassOf(object, model);
  return index ? model.classes[*index].score : 0;
}

}  // namespace kestrel
