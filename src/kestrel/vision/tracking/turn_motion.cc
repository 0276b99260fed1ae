// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tracking/turn_motion.h"

#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace kestrel {
namespace {

constexpr double kMaxStep_s = 0.05;
constexpr int kYaw = 12;

using StateMatrix = TurnState::Matrix;

double Sinc(double x) { return std::abs(x) < 1e-4 ? 1 - x * x / 6 : std::sin(x) / x; }

Eigen::Matrix2d Turn(double angle) { return Eigen::Rotation2Dd(angle).toRotationMatrix(); }

// Transition of the sway and its velocity over 't' seconds (exact solution).
Eigen::Matrix2d SwayTransition(const SwayMotion& sway, double t) {
  const double rate = sway.rate();
  const double damping = sway.damping * rate;
  const double damped_rate = std::sqrt(rate * rate - damping * damping);
  const double c = std::cos(damped_rate * t);
  const double s = std::sin(damped_rate * t) / damped_rate;
  Eigen::Matrix2d transition;
  transition << c + damping * s, s, -rate * rate * s, c - damping * s;
  return std::exp(-damping * t) * transition;
}

// Steady-state variances of the sway and its velocity under noise.
Eigen::Matrix2d SwayCovariance(const SwayMotion& sway) {
  const double variance = sway.sigma * sway.sigma;
  return Eigen::Vector2d(variance, sway.rate() * sway.rate() * variance).asDiagonal();
}

// Jacobian of a step of 't' seconds, with the turn rate at half time. A step along an arc is its
// chord, which has the direction of the velocity at half time. The change of the chord's length
// with the turn rate is neglected. Position and velocity include the sway, which does not turn.
StateMatrix StepJacobian(const TurnState& state, double t, const TurnNoise& noise) {
  const double angle = t * (state.mean(6) + state.mean(7) * t / 2);
  const double chord = t * Sinc(angle / 2);
  const Eigen::Vector2d velocity = state.mean.segment<2>(3) - state.mean.segment<2>(10);
  const Eigen::Vector2d left(-velocity.y(), velocity.x());
  const Eigen::Matrix2d sway = SwayTransition(noise.sway, t);
  const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
  StateMatrix jacobian = StateMatrix::Identity();
  jacobian.block<2, 2>(0, 3) = chord * Turn(angle / 2);
  jacobian.block<2, 1>(0, 6) = chord * t / 2 * (Turn(angle / 2) * left);
  jacobian(2, 5) = t;
  jacobian.block<2, 2>(3, 3) = Turn(angle);
  jacobian.block<2, 1>(3, 6) = t * (Turn(angle) * left);
  jacobian.block<5, 1>(0, 7) = t / 2 * jacobian.block<5, 1>(0, 6);
  jacobian(6, 7) = t;
  jacobian(kYaw, 6) = t;
  jacobian(kYaw, 7) = t * t / 2;
  jacobian(7, 7) = std::exp(-t / noise.turn_time_s);
  for (int to = 0; to < 2; ++to) {
    for (int from = 0; from < 2; ++from) {
      const Eigen::Matrix2d part = sway(to, from) * identity;
      jacobian.block<2, 2>(8 + 2 * to, 8 + 2 * from) = part;
      jacobian.block<2, 2>(3 * to, 8 + 2 * from) = part - jacobian.block<2, 2>(3 * to, 3 * from);
    }
  }
  return jacobian;
}

// Adds the covariance of white noise of root density 'noise' on the derivative of entry 'rate',
// whose integral is entry 'value', over 't' seconds.
void AddNoise(double noise, double t, int value, int rate, StateMatrix* covariance) {
  const double q = noise * noise;
  (*covariance)(value, value) += q * t * t * t / 3;
  (*covariance)(value, rate) += q * t * t / 2;
  (*covariance)(rate, value) += q * t * t / 2;
  (*covariance)(rate, rate) += q * t;
}

// Adds the noise that sustains the sway: as much as a step damps away.
void AddSwayNoise(const SwayMotion& sway, double t, StateMatrix* covariance) {
  const Eigen::Matrix2d transition = SwayTransition(sway, t);
  const Eigen::Matrix2d steady = SwayCovariance(sway);
  const Eigen::Matrix2d added = steady - transition * steady * transition.transpose();
  for (int axis = 0; axis < 2; ++axis) {
    const std::array<int, 4> entries = {axis, 3 + axis, 8 + axis, 10 + axis};
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) (*covariance)(entries[i], entries[j]) += added(i % 2, j % 2);
    }
  }
}

void Step(double t, const TurnNoise& noise, TurnState* state) {
  const StateMatrix jacobian = StepJacobian(*state, t, noise);
  StateMatrix& covariance = state->covariance;
  covariance = (jacobian * covariance * jacobian.transpose()).eval();
  AddNoise(noise.acceleration, t, 0, 3, &covariance);
  AddNoise(noise.acceleration, t, 1, 4, &covariance);
  AddNoise(noise.climb, t, 2, 5, &covariance);
  AddNoise(noise.turn, t, 6, 7, &covariance);
  AddSwayNoise(noise.sway, t, &covariance);
  // The path is not a linear function of the turn rate; the Jacobian's matrices already include it.
  const StateMatrix& by = jacobian;
  const TurnState::Vector now = state->mean;
  TurnState::Vector straight = now;
  straight.segment<2>(6).setZero();
  state->mean = by * straight;
  state->mean.segment<2>(6) = by.block<2, 2>(6, 6) * now.segment<2>(6);
  state->mean(kYaw) += by.block<1, 2>(kYaw, 6).dot(now.segment<2>(6));
}

}  // namespace

double SwayMotion::rate() const { return 2 * std::numbers::pi * frequency_hz; }

TurnState StartState(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance,
                     const Eigen::Vector3d& velocity_sigmas, double turn_sigma,
                     const TurnNoise& noise) {
  TurnState state;
  state.mean.head<3>() = position;
  state.covariance.topLeftCorner<3, 3>() = covariance;
  state.covariance.diagonal().segment<3>(3) = velocity_sigmas.cwiseAbs2();
  state.covariance.diagonal().segment<2>(6).setConstant(turn_sigma * turn_sigma);
  state.covariance(kYaw, kYaw) = std::numbers::pi * std::numbers::pi / 4;
  // The measurement includes the sway, so it says nothing about the sway's size. The velocity is
  // that of the vehicle plus that of the sway.
  const Eigen::Matrix2d sway = SwayCovariance(noise.sway);
  state.covariance.diagonal().segment<2>(8).setConstant(sway(0, 0));
  for (int axis = 0; axis < 2; ++axis) {
    const std::array<int, 2> entries = {3 + axis, 10 + axis};
    for (const int i : entries) {
      for (const int j : entries) state.covariance(i, j) += sway(1, 1);
    }
  }
  return state;
}

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

TurnState UpdateByYaw(const TurnState& state, double yaw, double variance, double gate) {
  const double offset = std::remainder(yaw - state.mean(kYaw), std::numbers::pi / 2);
  const double innovation = state.covariance(kYaw, kYaw) + variance;
  if (!(offset * offset <= gate * innovation)) return state;
  const TurnState::Vector gain = state.covariance.col(kYaw) / innovation;
  StateMatrix rest = StateMatrix::Identity();
  rest.col(kYaw) -= gain;
  TurnState updated;
  updated.mean = state.mean + gain * offset;
  updated.covariance = rest * state.covariance * rest.transpose();
  updated.covariance += variance * gain * gain.transpose();
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
