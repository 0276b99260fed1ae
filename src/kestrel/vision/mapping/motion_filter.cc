// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/mapping/motion_filter.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace kestrel {
namespace {

// Indices of velocity and acceleration in the state.
constexpr int kMotion = 3;
constexpr int kMotionSize = MappedObject::kStateSize - kMotion;

}  // namespace

MotionFilter::MotionFilter(const ObjectMeasurement& measurement, const ObjectMotion& motion) {
  standing_.state.head<3>() = measurement.position;
  // The position at the time of the frame is the measured one minus the errors and minus the motion
  // during the delay.
  Covariance back = Covariance::Identity();
  back.topRows<3>() = -ObservationOf(measurement);
  back.topLeftCorner<3, 3>().setIdentity();
  Covariance& errors = standing_.covariance;
  errors.topLeftCorner<3, 3>() = measurement.covariance;
  errors.diagonal().segment<3>(kWander).setConstant(std::pow(motion.wander_sigma_m, 2));
  errors(kClock, kClock) = std::pow(motion.clock_sigma_s, 2);
  driving_ = standing_;
  const Eigen::Vector3d axes(1, 1, kClimb);
  Eigen::Matrix<double, kMotionSize, 1> sigmas;
  sigmas << motion.start_speed_sigma_mps * axes, motion.acceleration_sigma_mps2 * axes;
  driving_.covariance.diagonal().segment<kMotionSize>(kMotion) = sigmas.cwiseAbs2();
  for (Hypothesis* hypothesis : {&standing_, &driving_}) {
    hypothesis->covariance = (back * hypothesis->covariance * back.transpose()).eval();
  }
}

void MotionFilter::Predict(double dt, const ObjectMotion& motion) {
  const double kept = std::exp(-dt / motion.wander_time_s);
  standing_.Predict(StandingStep(dt, motion), kept, motion.wander_sigma_m);
  driving_.Predict(DrivingStep(dt, motion), kept, motion.wander_sigma_m);
}

ExpectedPosition MotionFilter::Expect(const ObjectMeasurement& measurement) const {
  return driving_.Expect(measurement);
}

void MotionFilter::Fuse(const ObjectMeasurement& measurement, const ObjectMotion& motion) {
  // Bounds the evidence of one detection, which may be wrong.
  constexpr double kMaxEvidence = 2;
  const double of_driving = driving_.Fuse(measurement);
  const double evidence = of_driving - standing_.Fuse(measurement);
  const double most = motion.sure_log_odds + kMaxEvidence;
  log_odds_ += std::clamp(evidence, -kMaxEvidence, kMaxEvidence);
  log_odds_ = std::clamp(log_odds_, -most, most);
  if (log_odds_ > motion.sure_log_odds) moves_ = true;
  if (log_odds_ < 0) moves_ = false;
  if (log_odds_ == most) {
    // If the object stops, it stands here and not where it was first seen.
    standing_ = driving_;
    standing_.Stop();
  }
}

void MotionFilter::Publish(MappedObject* object) const {
  object->move_log_odds = log_odds_;
  object->moves = moves_;
  const Hypothesis& likelier = log_odds_ > 0 ? driving_ : standing_;
  object->state = likelier.state.head<MappedObject::kStateSize>();
  object->covariance =
      likelier.covariance.topLeftCorner<MappedObject::kStateSize, MappedObject::kStateSize>();
  if (log_odds_ > 0) return;
  const double probability = 1 / (1 + std::exp(-log_odds_));
  const Eigen::Matrix<double, kMotionSize, 1> motion = driving_.state.segment<kMotionSize>(kMotion);
  object->covariance.bottomRightCorner<kMotionSize, kMotionSize>() =
      probability * (driving_.covariance.block<kMotionSize, kMotionSize>(kMotion, kMotion) +
                     motion * motion.transpose());
}

void MotionFilter::Hypothesis::Predict(const MotionStep& step, double kept, double wander_sigma_m) {
  Covariance transition = Covariance::Identity();
  transition.topLeftCorner<kWander, kWander>() = step.transition;
  transition.diagonal().segment<3>(kWander).setConstant(kept);
  state = (transition * state).eval();
  covariance = (transition * covariance * transition.transpose()).eval();
  covariance.topLeftCorner<kWander, kWander>() += step.noise;
  covariance.diagonal().segment<3>(kWander).array() +=
      (1 - kept * kept) * wander_sigma_m * wander_sigma_m;
}

ExpectedPosition MotionFilter::Hypothesis::Expect(const ObjectMeasurement& measurement) const {
  const Observation observation = ObservationOf(measurement);
  return {observation * state, observation * covariance * observation.transpose()};
}

double MotionFilter::Hypothesis::Fuse(const ObjectMeasurement& measurement) {
  const Observation observation = ObservationOf(measurement);
  const Observation seen = observation * covariance;
  const Eigen::LLT<Eigen::Matrix3d> innovation(seen * observation.transpose() +
                                               measurement.covariance);
  const Eigen::Vector3d difference = measurement.position - observation * state;
  const Eigen::Matrix<double, kSize, 3> gain = innovation.solve(seen).transpose();
  state += gain * difference;
  // Joseph's form keeps the covariance symmetric and positive.
  const Covariance rest = Covariance::Identity() - gain * observation;
  covariance =
      (rest * covariance * rest.transpose() + gain * measurement.covariance * gain.transpose())
          .eval();
  return -0.5 * difference.dot(innovation.solve(difference)) -
         innovation.matrixLLT().diagonal().array().log().sum();
}

void MotionFilter::Hypothesis::Stop() {
  state.segment<kMotionSize>(kMotion).setZero();
  covariance.middleRows<kMotionSize>(kMotion).setZero();
  covariance.middleCols<kMotionSize>(kMotion).setZero();
}

MotionFilter::Observation MotionFilter::ObservationOf(const ObjectMeasurement& measurement) {
  Observation observation = Observation::Zero();
  observation.leftCols<3>().setIdentity();
  observation.middleCols<3>(kMotion).diagonal().setConstant(measurement.delay_s);
  observation.middleCols<3>(kWander).setIdentity();
  observation.col(kClock) = measurement.clock_shift;
  return observation;
}

}  // namespace kestrel
