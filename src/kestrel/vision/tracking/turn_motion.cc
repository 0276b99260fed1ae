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

using StateMatrix = TurnState::Matrix;
// Entries of the state.
constexpr int kPosition = TurnState::kPosition;
constexpr int kVelocity = TurnState::kVelocity;
constexpr int kTurnRate = TurnState::kTurnRate;
constexpr int kTurnChange = TurnState::kTurnChange;
constexpr int kSway = TurnState::kSway;
constexpr int kSwayVelocity = TurnState::kSwayVelocity;
constexpr int kYaw = TurnState::kYaw;
constexpr int kHeight = kPosition + 2;
constexpr int kClimb = kVelocity + 2;

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
  const double angle = t * (state.turn_rate() + state.turn_change() * t / 2);
  const double chord = t * Sinc(angle / 2);
  const Eigen::Vector2d velocity =
      state.mean.segment<2>(kVelocity) - state.mean.segment<2>(kSwayVelocity);
  const Eigen::Vector2d left(-velocity.y(), velocity.x());
  const Eigen::Matrix2d sway = SwayTransition(noise.sway, t);
  const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
  StateMatrix jacobian = StateMatrix::Identity();
  jacobian.block<2, 2>(kPosition, kVelocity) = chord * Turn(angle / 2);
  jacobian.block<2, 1>(kPosition, kTurnRate) = chord * t / 2 * (Turn(angle / 2) * left);
  jacobian(kHeight, kClimb) = t;
  jacobian.block<2, 2>(kVelocity, kVelocity) = Turn(angle);
  jacobian.block<2, 1>(kVelocity, kTurnRate) = t * (Turn(angle) * left);
  jacobian.block<kClimb, 1>(0, kTurnChange) = t / 2 * jacobian.block<kClimb, 1>(0, kTurnRate);
  jacobian(kTurnRate, kTurnChange) = t;
  jacobian(kYaw, kTurnRate) = t;
  jacobian(kYaw, kTurnChange) = t * t / 2;
  jacobian(kTurnChange, kTurnChange) = std::exp(-t / noise.turn_time_s);
  constexpr std::array<int, 2> kOfTarget = {kPosition, kVelocity};
  constexpr std::array<int, 2> kOfSway = {kSway, kSwayVelocity};
  for (int to = 0; to < 2; ++to) {
    for (int from = 0; from < 2; ++from) {
      const Eigen::Matrix2d part = sway(to, from) * identity;
      jacobian.block<2, 2>(kOfSway[to], kOfSway[from]) = part;
      jacobian.block<2, 2>(kOfTarget[to], kOfSway[from]) =
          part - jacobian.block<2, 2>(kOfTarget[to], kOfTarget[from]);
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
    const std::array<int, 4> entries = {kPosition + axis, kVelocity + axis, kSway + axis,
                                        kSwayVelocity + axis};
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) (*covariance)(entries[i], entries[j]) += added(i % 2, j % 2);
    }
  }
}

void Step(double t, const TurnNoise& noise, TurnState* state) {
  const StateMatrix jacobian = StepJacobian(*state, t, noise);
  StateMatrix& covariance = state->covariance;
  covariance = (jacobian * covariance * jacobian.transpose()).eval();
  AddNoise(noise.acceleration, t, kPosition, kVelocity, &covariance);
  AddNoise(noise.acceleration, t, kPosition + 1, kVelocity + 1, &covariance);
  AddNoise(noise.climb, t, kHeight, kClimb, &covariance);
  AddNoise(noise.turn, t, kTurnRate, kTurnChange, &covariance);
  AddSwayNoise(noise.sway, t, &covariance);
  // The path is not a linear function of the turn rate; the Jacobian's matrices already include it.
  const StateMatrix& by = jacobian;
  const TurnState::Vector now = state->mean;
  TurnState::Vector straight = now;
  straight.segment<2>(kTurnRate).setZero();
  state->mean = by * straight;
  state->mean.segment<2>(kTurnRate) =
      by.block<2, 2>(kTurnRate, kTurnRate) * now.segment<2>(kTurnRate);
  state->mean(kYaw) += by.block<1, 2>(kYaw, kTurnRate).dot(now.segment<2>(kTurnRate));
}

}  // namespace

double SwayMotion::rate() const { return 2 * std::numbers::pi * frequency_hz; }

TurnState StartState(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance,
                     const Eigen::Vector3d& velocity_sigmas, double turn_sigma,
                     const TurnNoise& noise) {
  TurnState state;
  state.mean.head<3>() = position;
  state.covariance.topLeftCorner<3, 3>() = covariance;
  state.covariance.diagonal().segment<3>(kVelocity) = velocity_sigmas.cwiseAbs2();
  state.covariance.diagonal().segment<2>(kTurnRate).setConstant(turn_sigma * turn_sigma);
  state.covariance(kYaw, kYaw) = std::numbers::pi * std::numbers::pi / 4;
  // The measurement includes the sway, so it does not determine the sway's size. The velocity is
  // that of the vehicle plus that of the sway.
  const Eigen::Matrix2d sway = SwayCovariance(noise.sway);
  state.covariance.diagonal().segment<2>(kSway).setConstant(sway(0, 0));
  for (int axis = 0; axis < 2; ++axis) {
    const std::array<int, 2> entries = {kVelocity + axis, kSwayVelocity + axis};
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

TurnState UpdateByYaw(const TurnState& state, double yaw, double variance, double period,
                      double gate) {
  const double offset = std::remainder(yaw - state.mean(kYaw), period);
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
