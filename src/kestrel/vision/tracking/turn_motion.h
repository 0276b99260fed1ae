// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace kestrel {

// How what a ground vehicle carries moves. The vehicle: at constant speed along a curve whose turn
// rate changes steadily, as in a road or a figure of eight, all disturbed by noise (a coordinated
// turn with one derivative more: docs/tracking.md has the comparison). The state has the velocity
// by its components, so that a standing target, which has no heading, is like any other (X. R. Li
// and V. P. Jilkov, Survey of maneuvering target tracking I, 2003, section V). The load sways on
// the vehicle's springs: a damped oscillator driven by noise in either horizontal axis. It turns
// with the vehicle. World frame, z up; m, s, rad.
inline constexpr int kTurnStateSize = 13;

struct TurnState {
  using Vector = Eigen::Matrix<double, kTurnStateSize, 1>;
  using Matrix = Eigen::Matrix<double, kTurnStateSize, kTurnStateSize>;

  // Position (3), velocity (3), turn rate of the vehicle about z and its derivative; of position
  // and velocity what is sway (2 and 2, horizontal); yaw of the load.
  Vector mean = Vector::Zero();
  Matrix covariance = Matrix::Zero();

  auto position() const { return mean.head<3>(); }
  auto velocity() const { return mean.segment<3>(3); }
  double turn_rate() const { return mean(6); }
  double turn_change() const { return mean(7); }  // derivative of the turn rate
};

// The swaying left alone: standard deviation (m; 0: none), frequency and damping ratio (0 to 1,
// exclusive).
struct SwayMotion {
  double sigma;
  double frequency_hz;
  double damping;

  double rate() const;  // rad/s
};

// Root spectral densities of the white noises that disturb the motion, and the sway.
struct TurnNoise {
  double acceleration;  // horizontal, m/s^2 per root of Hz
  double climb;         // vertical acceleration, m/s^2 per root of Hz
  double turn;          // of the turn rate's second derivative, rad/s^3 per root of Hz
  double turn_time_s;   // after which a change of the turn rate, left alone, ends (to 1/e)
  SwayMotion sway;
};

// What is known before anything was seen to move: standard deviations of the vehicle's velocity
// per axis, of its turn rate and of the derivative of that; the sway is that of 'noise', and of the
// yaw nothing is known.
TurnState StartState(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance,
                     const Eigen::Vector3d& velocity_sigmas, double turn_sigma,
                     const TurnNoise& noise);

// The state 'seconds' later (at least 0). In steps short enough for the turn
// rate to be constant, the covariance by the model's Jacobian.
TurnState Propagate(const TurnState& state, double seconds, const TurnNoise& noise);

// The state given a measured position (Kalman filter, Joseph's form).
TurnState UpdateByPosition(const TurnState& state, const Eigen::Vector3d& position,
                           const Eigen::Matrix3d& covariance);

// The state given a measured yaw (rad) of a load that looks the same after a quarter turn, unless
// that is further than 'gate' (squared, in variances) from where it should be.
TurnState UpdateByYaw(const TurnState& state, double yaw, double variance, double gate);

// Squared Mahalanobis distance of a measured position from the state's: chi-square with 3 degrees
// of freedom when both covariances are right.
double SquaredDistance(const TurnState& state, const Eigen::Vector3d& position,
                       const Eigen::Matrix3d& covariance);

}  // namespace kestrel
