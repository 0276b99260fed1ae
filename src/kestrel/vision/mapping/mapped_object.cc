// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/mapping/mapped_object.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace kestrel {
namespace {

// Motion of position, velocity and acceleration along one axis over a step.
struct AxisMotion {
  Eigen::Matrix3d transition;
  Eigen::Matrix3d noise;
};

// An acceleration that decays (Singer 1970) and a velocity that decays too, because nothing keeps
// its motion or accelerates for long. Computes a short step and doubles it until it is 'dt' (s)
// long.
AxisMotion PredictAxis(double dt, const ObjectMotion& motion) {
  constexpr double kShort_s = 1e-3;
  const int doublings = std::max(0, static_cast<int>(std::ceil(std::log2(dt / kShort_s))));
  const double step = std::ldexp(dt, -doublings);
  Eigen::Matrix3d rates;
  rates << 0, 1, 0,                           //
      0, -1 / motion.velocity_time_s, 1,      //
      0, 0, -1 / motion.acceleration_time_s;  //
  const Eigen::Matrix3d change = step * rates;
  AxisMotion axis{Eigen::Matrix3d::Identity() + change + 0.5 * change * change,
                  Eigen::Matrix3d::Zero()};
  // This noise keeps the variance of the acceleration constant.
  axis.noise(2, 2) =
      std::pow(motion.acceleration_sigma_mps2, 2) * (1 - std::pow(axis.transition(2, 2), 2));
  for (int i = 0; i < doublings; ++i) {
    axis.noise += (axis.transition * axis.noise * axis.transition.transpose()).eval();
    axis.transition = (axis.transition * axis.transition).eval();
  }
  return axis;
}

// Merges the first kSize numbers of two states, weighted by the inverse of their covariances.
template <int kSize>
void UnifyStates(const MappedObject& other, MappedObject* kept) {
  using Covariance = Eigen::Matrix<double, kSize, kSize>;
  const Covariance own = kept->covariance.topLeftCorner<kSize, kSize>();
  const Covariance sum = own + other.covariance.topLeftCorner<kSize, kSize>();
  const Covariance gain = sum.fullPivLu().solve(own).transpose();
  const Eigen::Matrix<double, kSize, 1> difference =
      other.state.head<kSize>() - kept->state.head<kSize>();
  kept->state.head<kSize>() += gain * difference;
  const Covariance left = own - gain * own;
  kept->covariance.topLeftCorner<kSize, kSize>() = 0.5 * (left + left.transpose());
}

void UnifyMotions(const MappedObject& other, MappedObject* kept) {
  if (kept->moves != other.moves) {
    const auto sureness = [](const MappedObject& object) {
      return std::pair(std::abs(object.move_log_odds), object.last_seen);
    };
    if (sureness(other) > sureness(*kept)) {
      kept->state = other.state;
      kept->covariance = other.covariance;
      kept->moves = other.moves;
    }
  } else if (kept->may_move || other.may_move) {
    // The velocity of a standing object has no covariance, so the solver must accept singular
    // matrices.
    UnifyStates<MappedObject::kStateSize>(other, kept);
  } else {
    UnifyStates<3>(other, kept);
  }
  kept->move_log_odds += other.move_log_odds;
}

}  // namespace

double MappedObject::sigma_m() const {
  return std::sqrt(covariance.topLeftCorner<3, 3>().trace() / 3);
}

std::size_t MappedObject::color_index() const {
  const auto best = std::max_element(color_log_likelihoods.begin(), color_log_likelihoods.end());
  return best - color_log_likelihoods.begin();
}

std::optional<LikelyDigit> MappedObject::digit() const {
  const DigitLikelihoods& logs = digit_log_likelihoods;
  const double best = *std::max_element(logs.begin(), logs.end());
  const bool was_read = std::any_of(logs.begin(), logs.end(), [&](double x) { return x < best; });
  if (shape != ObjectShape::kCuboid || !was_read) return std::nullopt;
  DigitLikelihoods likelihoods;
  double total = 0;
  for (std::size_t i = 0; i < logs.size(); ++i) total += likelihoods[i] = std::exp(logs[i] - best);
  for (double& likelihood : likelihoods) likelihood /= total;
  return LikeliestDigit(likelihoods);
}

MotionStep DrivingStep(double dt, const ObjectMotion& motion) {
  const AxisMotion axis = PredictAxis(dt, motion);
  const Eigen::DiagonalMatrix<double, 3> shares(1, 1, kClimb * kClimb);
  MotionStep step;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      step.transition.block<3, 3>(3 * i, 3 * k) =
          axis.transition(i, k) * Eigen::Matrix3d::Identity();
      step.noise.block<3, 3>(3 * i, 3 * k) = axis.noise(i, k) * shares.toDenseMatrix();
    }
  }
  return step;
}

MotionStep StandingStep(double dt, const ObjectMotion& motion) {
  MotionStep step{MappedObject::Covariance::Identity(), MappedObject::Covariance::Zero()};
  step.noise.topLeftCorner<3, 3>().diagonal().setConstant(motion.drift_noise * motion.drift_noise *
                                                          dt);
  return step;
}

void PredictObject(Time time, const ObjectMotion& motion, MappedObject* object) {
  const double dt = ToSeconds(time - object->time);
  if (!(dt > 0)) return;
  object->time = time;
  const MotionStep step = object->may_move ? DrivingStep(dt, motion) : StandingStep(dt, motion);
  object->state = (step.transition * object->state).eval();
  object->covariance =
      (step.transition * object->covariance * step.transition.transpose() + step.noise).eval();
}

void UnifyObjects(const MappedObject& other, MappedObject* kept) {
  UnifyMotions(other, kept);
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
  if (const auto digit = object.digit()) return digit->digit;
  const auto index = ClassOf(object, model);
  return index ? model.classes[*index].score : 0;
}

}  // namespace kestrel
