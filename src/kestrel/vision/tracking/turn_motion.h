// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace kestrel {

// Motion model of a ground vehicle's load. The vehicle drives at constant speed along a curve whose
// turn rate changes steadily, as on a road or a figure of eight, disturbed by noise (a coordinated
// turn with one more derivative; docs/tracking.md has a comparison). The state has the components
// of the velocity, so that a standing target, which has no heading, is no special case (X. R. Li
// and V. P. Jilkov, Survey of maneuvering target tracking I, 2003, section V). The load sways on
// the vehicle's springs: a damped oscillator driven by noise along each horizontal axis. It turns
// with the vehicle. World frame, z up; m, s, rad.
inline constexpr int kTurnStateSize = 13;

struct TurnState {
  using Vector = Eigen::Matrix<double, kTurnStateSize, 1>;
  using Matrix = Eigen::Matrix<double, kTurnStateSize, kTurnStateSize>;

  // Entries: position and velocity (3 each), turn rate of the vehicle about z and its derivative,
  // the sway's part of position and velocity (2 each, horizontal), yaw of the load.
  static constexpr int kPosition = 0;
  static constexpr int kVelocity = 3;
  static constexpr int kTurnRate = 6;
  static constexpr int kTurnChange = 7;
  static constexpr int kSway = 8;
  static constexpr int kSwayVelocity = 10;
  static constexpr int kYaw = 12;

  Vector mean = Vector::Zero();
  Matrix covariance = Matrix::Zero();

  auto position() const { return mean.segment<3>(kPosition); }
  auto velocity() const { return mean.segment<3>(kVelocity); }
  double turn_rate() const { return mean(kTurnRate); }
  double turn_change() const { return mean(kTurnChange); }  // derivative of the turn rate
  double yaw() const { return mean(kYaw); }
};

// Undisturbed sway: standard deviation (m; 0: none), frequency and damping ratio (0 to 1,
// exclusive).
struct SwayMotion {
  double sigma;
  double frequency_hz;
  double damping;

  double rate() const;  // rad/s
};

// Root spectral densities of the white noises that disturb motion and sway.
struct TurnNoise {
  double acceleration;  // horizontal, m/s^2 per root of Hz
  double climb;         // vertical acceleration, m/s^2 per root of Hz
  double turn;          // second derivative of the turn rate, rad/s^3 per root of Hz
  double turn_time_s;   // decay of an undisturbed change of the turn rate (to 1/e)
  SwayMotion sway;
};

// Returns the state before any motion was seen. Standard deviations: the vehicle's velocity per
// axis, its turn rate and the derivative of that. The sway is that of 'noise', and the yaw is
// unknown.
TurnState StartState(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance,
                     const Eigen::Vector3d& velocity_sigmas, double turn_sigma,
                     const TurnNoise& noise);

// Returns the state 'seconds' (at least 0) later. Uses steps short enough for a constant turn rate;
// the covariance follows from the model's Jacobian.
TurnState Propagate(const TurnState& state, double seconds, const TurnNoise& noise);

// Returns the state updated by a measured position (Kalman filter, Joseph's form).
TurnState UpdateByPosition(const TurnState& state, const Eigen::Vector3d& position,
                           const Eigen::Matrix3d& covariance);

// Returns the state updated by a measured yaw (rad) of a load that looks the same after a turn by
// 'period' (rad). Ignores a yaw farther than 'gate' (squared, in variances) from the expected one.
TurnState UpdateByYaw(const TurnState& state, double yaw, double variance, double period,
                      double gate);

// Returns the squared Mahalanobis distance of a measured position from the state's: chi-square with
// 3 degrees of freedom when both covariances are right.
double SquaredDistance(const TurnState& state, const Eigen::Vector3d& position,
                       const Eigen::Matrix3d& covariance);

}  // namespace kestrel
