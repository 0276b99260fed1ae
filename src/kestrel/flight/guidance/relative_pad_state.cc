// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/relative_pad_state.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Axis = RelativePadState::Axis;

// The acceleration of a pad that drives, and of gusts, which act like one; upwards also the rotors'
// own errors. Memory and standard deviation.
constexpr double kPadMemory_s = 4, kGustMemory_s = 0.7;
constexpr double kDriving = 1, kGusts = 1;  // m/s^2
constexpr double kLifting = 1,
                 kHovering = 0.5;     // m/s^2, of a pad that moves, and of one that stands
constexpr double kBiasWalk = 0.05;    // m/s^2 per square root of a second
constexpr double kBiasAtFirst = 1;    // m/s^2: 3 m/s of wind, 2 degrees
constexpr double kThrustAtFirst = 2;  // m/s^2: a hover thrust that is wrong by a fifth
// Also what an attitude of another time than the frame, by some ms, is wrong by: the estimate is
// slower from higher up, where that would make the UAV swing.
constexpr double kAttitudeNoise = Radians(0.5);
// What a camera near the pad is wrong by, that its pixels do not show, and its stamps.
constexpr double kPlaceNoise_m = 0.003, kStampNoise_s = 0.005;
constexpr double kThrustLag_s = 0.12;
// The vibration of the accelerometer is measured in so long, and smoothed until this is left of it
// (m/s^2), but not less.
constexpr double kVibration_s = 2, kNoise = 0.1, kQuickest_s = 0.05;
constexpr double kMeasured_s = 0.3;  // so long its newest value counts
// Memory of the mean disturbance, and how long without the pad the newest one is flown against.
// Later the mean one is: to cancel all of the wind takes away what brakes a UAV that nobody sees.
constexpr double kSteady_s = 4, kNewest_s = 3;
constexpr double kMeasuredGusts = 0.2;  // m/s^2, what the accelerometer leaves of gusts
constexpr double kContradiction = 25;   // squared, in variances
constexpr double kContradicted_s = 0.5;
// Noise of the UAV's own velocity in a report, which repeats errors of those before. It counts once
// the pad has been out of sight for so long.
constexpr double kOwnVelocityNoise = 0.3, kOutOfSight_s = 0.3;
constexpr double kSubStep_s = 0.05;
constexpr double kLargestGap_s = 0.5;  // between two attitudes
constexpr double kLongestCoast_s = 60;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double SquareOf(double value) { return value * value; }

double NoiseOf(const Axis& axis, double variance) {
  return variance + SquareOf(kPlaceNoise_m) +
         SquareOf(kStampNoise_s * axis.mean(RelativePadState::kVelocity));
}

// The Kalman filter's correction by a measurement of one state.
void Update(int index, double measured, double variance, Axis* axis) {
  const Eigen::Vector4d gain =
      axis->covariance.col(index) / (axis->covariance(index, index) + variance);
  axis->mean += gain * (measured - axis->mean(index));
  const Eigen::RowVector4d row = axis->covariance.row(index);
  axis->covariance -= gain * row;
  axis->covariance = (axis->covariance + axis->covariance.transpose().eval()) / 2;
}

}  // namespace

double RelativePadState::Estimate::Sigma(int index) const {
  return std::sqrt((axes[0].covariance(index, index) + axes[1].covariance(index, index)) / 2);
}

double RelativePadState::Estimate::ClimbSigma() const {
  return std::sqrt(axes[2].covariance(kVelocity, kVelocity));
}

double RelativePadState::Estimate::DriftSigma(double seconds) const {
  const double bias = SquareOf(Sigma(kBias)) + SquareOf(kBiasWalk) * seconds / 5;
  return std::sqrt(SquareOf(Sigma(kVelocity) * seconds) + bias * SquareOf(seconds * seconds / 2));
}

RelativePadState::RelativePadState(bool pad_moves) : pad_moves_(pad_moves) {}

// The heading follows the gyros from the attitude before: a compass that turns the autopilot's
// world does not turn this frame.
bool RelativePadState::AddAttitude(Time time, const Quaterniond& world_from_body,
                                   const Vector3d& rate_in_body) {
  double step_s = 0;
  if (size_ > 0) {
    step_s = ToSeconds(time - InputAt(size_ - 1).time);
    if (!(step_s > 0)) return false;
    if (step_s > kLargestGap_s) {
      size_ = 0;
      sighted_.reset();
    }
    const double turned_s = std::min(step_s, kLargestGap_s);
    heading_ +=
        HeadingOf(last_attitude_ * RotationBy(turned_s * rate_in_body)) - HeadingOf(last_attitude_);
  }
  if (sighted_ && ToSeconds(time - *sighted_) > kLongestCoast_s) sighted_.reset();
  last_attitude_ = world_from_body;
  thrust_ += (1 - std::exp(-step_s / kThrustLag_s)) * (commanded_ - thrust_);
  const Eigen::AngleAxisd turn(heading_ - HeadingOf(world_from_body), Vector3d::UnitZ());
  const Quaterniond level_from_body(turn * world_from_body);
  const Vector3d up = level_from_body * Vector3d::UnitZ();
  Vector3d acceleration = (kGravity + thrust_) / std::max(up.z(), 0.5) * up;
  acceleration.z() = thrust_;
  if (size_ == kInputs) {
    if (sighted_ && state_time_ < InputAt(1).time) {
      Propagate(state_time_, InputAt(1).time, &axes_);
      state_time_ = InputAt(1).time;
    }
    first_ = (first_ + 1) % kInputs;
    --size_;
  }
  if (measured_ && ToSeconds(time - *measured_) > kMeasured_s) ForgetDisturbance();
  inputs_[(first_ + size_) % kInputs] = {time, level_from_body, acceleration,
                                         acceleration + disturbance_, Vector3d::Constant(kUnknown)};
  ++size_;
  return true;
}

void RelativePadState::AddAcceleration(Time time, const Vector3d& measured) {
  if (size_ == 0) return;
  const Input& last = InputAt(size_ - 1);
  const Vector3d sensed = last.level_from_body * measured - kGravity * Vector3d::UnitZ();
  const double step_s = measured_ ? std::max(ToSeconds(time - *measured_), 0.0) : 0;
  if (step_s > 0) {
    const double change = (sensed - sensed_).squaredNorm() / 6;  // two samples, three axes
    vibration_ += std::min(step_s / kVibration_s, 1.0) * (change - vibration_);
    const double smoothing_s =
        std::clamp(step_s / 2 * vibration_ / SquareOf(kNoise), kQuickest_s, kSteady_s);
    disturbance_ += (1 - std::exp(-step_s / smoothing_s)) * (sensed - last.model - disturbance_);
  }
  sensed_ = sensed;
  if (!IsUnseen(time)) steady_ += (1 - std::exp(-step_s / kSteady_s)) * (disturbance_ - steady_);
  measured_ = time;
}

// The accelerometer is not heard any more: its disturbance goes on as a bias.
void RelativePadState::ForgetDisturbance() {
  for (int i = 0; i < 3; ++i) axes_[static_cast<std::size_t>(i)].mean(kBias) += disturbance_(i);
  disturbance_.setZero();
  steady_.setZero();
  measured_.reset();
}

void RelativePadState::AddOwnVelocity(const Vector3d& velocity_in_world) {
  if (size_ == 0) return;
  const Eigen::AngleAxisd turn(heading_ - HeadingOf(last_attitude_), Vector3d::UnitZ());
  const Vector3d level = turn * Vector3d(velocity_in_world.x(), velocity_in_world.y(), 0);
  Vector3d& velocity = inputs_[(first_ + size_ - 1) % kInputs].velocity;
  if (level.allFinite() && !pad_moves_) velocity.head<2>() = level.head<2>();
  if (std::isfinite(velocity_in_world.z())) velocity.z() = velocity_in_world.z();
}

void RelativePadState::ForgetThrust() {
  Matrix4d& covariance = axes_[2].covariance;
  covariance.row(kBias).setZero();
  covariance.col(kBias).setZero();
  covariance(kBias, kBias) = SquareOf(kThrustAtFirst);
}

bool RelativePadState::AddSight(Time exposure, const Vector3d& pad_in_body,
                                const Matrix3d& covariance) {
  const auto level_from_body = LevelFromBodyAt(exposure);
  if (!level_from_body || (sighted_ && exposure <= state_time_)) return false;
  const Matrix3d rotation = level_from_body->toRotationMatrix();
  const Vector3d way = rotation * pad_in_body;
  Vector3d variance = (rotation * covariance * rotation.transpose()).diagonal();
  const double lever = SquareOf(kAttitudeNoise);
  variance.head<2>().array() += lever * SquareOf(way.z());
  variance.z() += lever * way.head<2>().squaredNorm();
  if (!way.allFinite() || !variance.allFinite()) return false;
  if (!sighted_) {
    Begin(exposure, way, variance);
    return true;
  }
  const std::array<Axis, 3> before = axes_;
  Propagate(state_time_, exposure, &axes_);
  if (Correct(way, variance)) {
    sighted_ = state_time_ = exposure;
    contradicted_.reset();
    return true;
  }
  axes_ = before;
  if (!contradicted_) contradicted_ = exposure;
  if (ToSeconds(exposure - *contradicted_) < kContradicted_s) return false;
  Begin(exposure, way, variance);
  return true;
}

// The bias is the UAV's own: it stays when another pad is seen.
void RelativePadState::Begin(Time time, const Vector3d& way, const Vector3d& variance) {
  constexpr double kStanding_mps = 1.5, kDriving_mps = 3;
  const bool is_known = sighted_.has_value();
  for (int i = 0; i < 3; ++i) {
    Axis& axis = axes_[static_cast<std::size_t>(i)];
    const double bias = is_known ? axis.mean(kBias) : 0;
    const double bias_variance =
        is_known ? axis.covariance(kBias, kBias) : SquareOf(i < 2 ? kBiasAtFirst : kThrustAtFirst);
    axis.mean << way(i), 0, 0, bias;
    axis.covariance.setZero();
    axis.covariance.diagonal() << variance(i), SquareOf(pad_moves_ ? kDriving_mps : kStanding_mps),
        SquareOf(pad_moves_ ? kDriving : kGusts), bias_variance;
  }
  sighted_ = state_time_ = time;
  contradicted_.reset();
}

// False, and unchanged, when an axis contradicts it.
bool RelativePadState::Correct(const Vector3d& way, const Vector3d& variance) {
  for (int i = 0; i < 3; ++i) {
    const Axis& axis = axes_[static_cast<std::size_t>(i)];
    const double expected = axis.covariance(kWay, kWay) + NoiseOf(axis, variance(i));
    if (SquareOf(way(i) - axis.mean(kWay)) > kContradiction * expected) return false;
  }
  for (int i = 0; i < 3; ++i) {
    Axis& axis = axes_[static_cast<std::size_t>(i)];
    Update(kWay, way(i), NoiseOf(axis, variance(i)), &axis);
  }
  return true;
}

bool RelativePadState::IsUnseen(Time time) const {
  return !sighted_ || ToSeconds(time - *sighted_) >= kOutOfSight_s;
}

void RelativePadState::CorrectVelocity(const Input& input, std::array<Axis, 3>* axes) const {
  if (!IsUnseen(input.time)) return;
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(input.velocity(i))) continue;
    Axis& axis = (*axes)[static_cast<std::size_t>(i)];
    Update(kVelocity, -input.velocity(i), SquareOf(kOwnVelocityNoise), &axis);
  }
}

std::optional<RelativePadState::Estimate> RelativePadState::At(Time time) const {
  if (!sighted_ || size_ == 0) return std::nullopt;
  Estimate estimate{axes_};
  Propagate(state_time_, std::max(time, state_time_), &estimate.axes);
  const bool is_newest = ToSeconds(time - *sighted_) < kNewest_s;
  for (int i = 0; i < 3; ++i) {
    estimate.axes[static_cast<std::size_t>(i)].mean(kBias) +=
        i == 2 || is_newest ? disturbance_(i) : steady_(i);
  }
  // Into the axes of the heading. The two horizontal filters hardly differ in their covariance.
  const Eigen::Rotation2Dd turn(-heading_);
  for (const int index : {kWay, kVelocity, kAcceleration, kBias}) {
    const Eigen::Vector2d turned =
        turn * Eigen::Vector2d(estimate.axes[0].mean(index), estimate.axes[1].mean(index));
    estimate.axes[0].mean(index) = turned.x();
    estimate.axes[1].mean(index) = turned.y();
  }
  return estimate;
}

// Returns the last input that is not after 'time'; nothing: there is none, or the newest is old.
std::optional<std::size_t> RelativePadState::IndexAt(Time time) const {
  if (size_ == 0 || time < InputAt(0).time) return std::nullopt;
  if (ToSeconds(time - InputAt(size_ - 1).time) > kLargestGap_s) return std::nullopt;
  std::size_t index = size_ - 1;
  while (InputAt(index).time > time) --index;
  return index;
}

std::optional<Quaterniond> RelativePadState::LevelFromBodyAt(Time time) const {
  const auto index = IndexAt(time);
  if (!index) return std::nullopt;
  return LevelFromBody(time, *index);
}

double RelativePadState::Nose() const {
  return size_ > 0 ? LevelHeadingOf(InputAt(size_ - 1).level_from_body) : 0;
}

Quaterniond RelativePadState::LevelFromBody(Time time, std::size_t index) const {
  const Input& before = InputAt(index);
  if (index + 1 == size_) return before.level_from_body;
  const Input& after = InputAt(index + 1);
  const double part = ToSeconds(time - before.time) / ToSeconds(after.time - before.time);
  return before.level_from_body.slerp(part, after.level_from_body);
}

void RelativePadState::Propagate(Time from, Time to, std::array<Axis, 3>* axes) const {
  std::size_t index = IndexAt(from).value_or(0);
  while (from < to) {
    const bool is_last = index + 1 >= size_;
    const Time end = is_last ? to : std::min(to, InputAt(index + 1).time);
    const Vector3d acceleration =
        is_last ? InputAt(index).acceleration
                : Vector3d((InputAt(index).acceleration + InputAt(index + 1).acceleration) / 2);
    const double gusts = measured_ && IsUnseen(from) ? kMeasuredGusts : kGusts;
    Step(ToSeconds(end - from), acceleration, gusts, axes);
    from = end;
    ++index;
    if (is_last) return;
    if (end == InputAt(index).time) CorrectVelocity(InputAt(index), axes);
  }
}

void RelativePadState::Step(double seconds, const Vector3d& acceleration, double gusts,
                            std::array<Axis, 3>* axes) const {
  for (; seconds > 0; seconds -= kSubStep_s) {
    const double dt = std::min(seconds, kSubStep_s);
    const double kept = std::exp(-dt / (pad_moves_ ? kPadMemory_s : kGustMemory_s));
    Matrix4d change = Matrix4d::Identity();
    change(kWay, kVelocity) = dt;
    change(kWay, kAcceleration) = dt * dt / 2;
    change(kWay, kBias) = -dt * dt / 2;
    change(kVelocity, kAcceleration) = dt;
    change(kVelocity, kBias) = -dt;
    change(kAcceleration, kAcceleration) = kept;
    for (int i = 0; i < 3; ++i) {
      Axis& axis = (*axes)[static_cast<std::size_t>(i)];
      axis.mean = change * axis.mean;
      axis.mean(kWay) -= dt * dt / 2 * acceleration(i);
      axis.mean(kVelocity) -= dt * acceleration(i);
      const double pad =
          i < 2 ? (pad_moves_ ? kDriving : gusts) : (pad_moves_ ? kLifting : kHovering);
      axis.covariance = change * axis.covariance * change.transpose();
      axis.covariance(kAcceleration, kAcceleration) += SquareOf(pad) * (1 - kept * kept);
      axis.covariance(kBias, kBias) += SquareOf(kBiasWalk) * dt;
    }
  }
}

}  // namespace kestrel
