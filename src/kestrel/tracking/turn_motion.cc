// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/tracking/turn_motion.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace kestrel {
namespace {

constexpr double kMaxStep_s = 0.05;

using StateMatrix = TurnState::Matrix;

double Sinc(double x) { return std::abs(x) < 1e-4 ? 1 - x * x / 6 : std::sin(x) / x; }

Eigen::Matrix2d Turn(double angle) { return Eigen::Rotation2Dd(angle).toRotationMatrix(); }

// The Jacobian of a step of 't' seconds, with the turn rate of half time. A step of an arc is its
// chord, which has the direction of the velocity at half time; the change of the chord's length
// with the turn rate is left out.
StateMatrix StepJacobian(const TurnState& state, double t, const TurnNoise& noise) {
  const double angle = t * (state.mean(6) + state.mean(7) * t / 2);
  const double chord = t * Sinc(angle / 2);
  const Eigen::Vector2d velocity = state.mean.segment<2>(3);
  const Eigen::Vector2d left(-velocity.y(), velocity.x());
  StateMatrix jacobian = StateMatrix::Identity();
  jacobian.block<2, 2>(0, 3) = chord * Turn(angle / 2);
  jacobian.block<2, 1>(0, 6) = chord * t / 2 * (Turn(angle / 2) * left);
  jacobian(2, 5) = t;
  jacobian.block<2, 2>(3, 3) = Turn(angle);
  jacobian.block<2, 1>(3, 6) = t * (Turn(angle) * left);
  jacobian.block<5, 1>(0, 7) = t / 2 * jacobian.block<5, 1>(0, 6);
  jacobian(6, 7) = t;
  jacobian(7, 7) = std::exp(-t / noise.turn_time_s);
  return jacobian;
}

// White noise of root density 'noise' on the derivative of entry 'rate', whose integral is entry
// 'value', for 't' seconds.
void AddNoise(double noise, double t, int value, int rate, StateMatrix* covariance) {
  const double q = noise * noise;
  (*covariance)(value, value) += q * t * t * t / 3;
  (*covariance)(value, rate) += q * t * t / 2;
  (*covariance)(rate, value) += q * t * t / 2;
  (*covariance)(rate, rate) += q * t;
}

void Step(double t, const TurnNoise& noise, TurnState* state) {
  const StateMatrix jacobian = StepJacobian(*state, t, noise);
  StateMatrix& covariance = state->covariance;
  covariance = (jacobian * covariance * jacobian.transpose()).eval();
  AddNoise(noise.acceleration, t, 0, 3, &covariance);
  AddNoise(noise.acceleration, t, 1, 4, &covariance);
  AddNoise(noise.climb, t, 2, 5, &covariance);
  AddNoise(noise.turn, t, 6, 7, &covariance);
  const Eigen::Vector2d velocity = state->mean.segment<2>(3);
  state->mean.head<2>() += jacobian.block<2, 2>(0, 3) * velocity;
  state->mean(2) += t * state->mean(5);
  state->mean.segment<2>(3) = jacobian.block<2, 2>(3, 3) * velocity;
  state->mean(6) += t * state->mean(7);
  state->mean(7) *= jacobian(7, 7);
}

}  // namespace

TurnState Propagate(const TurnState& state, double seconds, const TurnNoise& noise) {
  TurnState later = state;
  const int steps = static_cast<int>(std::ceil(seconds / kMaxStep_s));
  for (int i = 0; i < steps; ++i) Step(seconds / steps, noise, &later);
  return later;
}

TurnState UpdateByPosition(const TurnState& state, const Eigen::Vector3d& position,
                           const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d innovation = state.covariance.topLeftCorner<3, 3>() + covariance;
  const Eigen::Matrix<double, kTurnStateSize, 3> gain =
      innovation.ldlt().solve(state.covariance.topRows<3>()).transpose();
  StateMatrix rest = StateMatrix::Identity();
  rest.leftCols<3>() -= gain;
  TurnState updated;
  updated.mean = state.mean + gain * (position - state.position());
  updated.covariance = rest * state.covariance * rest.transpose();
  updated.covariance += gain * covariance * gain.transpose();
  updated.covariance = (0.5 * (updated.covariance + updated.covariance.transpose())).eval();
  return updated;
}

double SquaredDistance(const TurnState& state, const Eigen::Vector3d& position,
                       const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d innovation = state.covariance.topLeftCorner<3, 3>() + covariance;
  const Eigen::Vector3d offset = position - state.position();
  return offset.dot(innovation.ldlt().solve(offset));
}

}  // namespace kestrel
