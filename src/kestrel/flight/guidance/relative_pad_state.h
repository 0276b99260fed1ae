// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "kestrel/core/base/time.h"

namespace kestrel {

// The pad relative to the UAV, of an autopilot that knows neither place nor velocity: from where
// frames show the pad and from the autopilot's attitude. Its frame is level, and turns with the
// UAV by the gyros alone: no north, and no compass, enters.
//
// For each axis of the frame a Kalman filter has the way from the UAV to the pad, its change, the
// pad's acceleration (an Ornstein-Uhlenbeck process), and one bias, a random walk: what tilt error,
// wind and, upwards, an unknown thrust of the rotors add to the UAV's acceleration by its lean.
// They cannot be told apart, and need not be. Where the autopilot sends what its accelerometer
// measures, gusts are known as they come: what it measures beyond lean and thrust counts at once. A
// frame counts at its exposure: the filter stays there, and is predicted to the present by the
// attitudes since. While no frame shows the pad, the UAV's own velocity counts, as far as the
// autopilot knows it: that of a pad that stands is its opposite. Neither throws nor allocates.
class RelativePadState {
 public:
  static constexpr int kWay = 0, kVelocity = 1, kAcceleration = 2, kBias = 3;
  using AxisState = Eigen::Vector4d;  // as numbered above; m, m/s, m/s^2, m/s^2
  struct Axis {
    AxisState mean = AxisState::Zero();
    Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  };

  // In axes of the UAV's heading: ahead, to the left, up.
  struct Estimate {
    std::array<Axis, 3> axes;

    Eigen::Vector3d Part(int index) const {
      return {axes[0].mean(index), axes[1].mean(index), axes[2].mean(index)};
    }
    Eigen::Vector3d way() const { return Part(kWay); }
    Eigen::Vector3d velocity() const { return Part(kVelocity); }
    Eigen::Vector3d pad_acceleration() const { return Part(kAcceleration); }
    Eigen::Vector3d bias() const { return Part(kBias); }
    double Sigma(int index) const;  // horizontal, per axis
    double ClimbSigma() const;      // of the vertical velocity, m/s
    // How far the UAV is off its way after so many seconds by this bias alone; horizontal, per
    // axis, one standard deviation, m.
    double DriftSigma(double seconds) const;
  };

  // 'pad_moves': it may drive, or be carried. Otherwise changes are those of gusts.
  explicit RelativePadState(bool pad_moves);

  // The autopilot's attitude, and its turn rate in the body (rad/s). In order of time.
  // False when it was not used: it is not later than the one before.
  bool AddAttitude(Time time, const Eigen::Quaterniond& world_from_body,
                   const Eigen::Vector3d& rate_in_body);
  // Takes what the accelerometer measures in the body (FLU), m/s^2: upwards at rest.
  void AddAcceleration(Time time, const Eigen::Vector3d& measured);
  // Takes the UAV's velocity in the autopilot's world (m/s) at the newest attitude, by what the
  // autopilot measures without this program; NaN in an axis: it does not know.
  void AddOwnVelocity(const Eigen::Vector3d& velocity_in_world);
  // From now on the rotors are commanded to accelerate the UAV upwards by so much (m/s^2).
  void set_climb_acceleration(double acceleration) { commanded_ = acceleration; }
  // The thrust that was learnt is another one from now on, as when another control takes over.
  void ForgetThrust();
  // A frame taken at 'exposure' shows the pad there in the body (FLU, m), with this covariance.
  // False when it was not used: there is no attitude of that time, it is older than the one before,
  // or it contradicts the estimate; after half a second of contradictions the estimate begins anew.
  bool AddSight(Time exposure, const Eigen::Vector3d& pad_in_body,
                const Eigen::Matrix3d& covariance);

  // Time of the newest frame that was used; nothing: there is no estimate.
  const std::optional<Time>& sighted() const { return sighted_; }
  // The body in the level frame at that time; nothing: there is no attitude of it.
  std::optional<Eigen::Quaterniond> LevelFromBodyAt(Time time) const;
  // Heading of the levelled nose in that frame by the newest attitude, rad.
  double Nose() const;
  // Nothing: no frame has shown the pad, or there are no attitudes.
  std::optional<Estimate> At(Time time) const;

 private:
  // From this time to that of the next one.
  struct Input {
    Time time;
    Eigen::Quaterniond level_from_body;
    Eigen::Vector3d model;         // acceleration by lean and commanded thrust
    Eigen::Vector3d acceleration;  // the same with the disturbance
    Eigen::Vector3d velocity;      // of the UAV; NaN: not known
  };
  static constexpr std::size_t kInputs = 512;

  const Input& InputAt(std::size_t i) const { return inputs_[(first_ + i) % kInputs]; }
  std::optional<std::size_t> IndexAt(Time time) const;
  void ForgetDisturbance();
  bool IsUnseen(Time time) const;
  Eigen::Quaterniond LevelFromBody(Time time, std::size_t index) const;
  void Begin(Time time, const Eigen::Vector3d& way, const Eigen::Vector3d& variance);
  bool Correct(const Eigen::Vector3d& way, const Eigen::Vector3d& variance);
  void CorrectVelocity(const Input& input, std::array<Axis, 3>* axes) const;
  void Propagate(Time from, Time to, std::array<Axis, 3>* axes) const;
  void Step(double seconds, const Eigen::Vector3d& acceleration, double gusts,
            std::array<Axis, 3>* axes) const;

  bool pad_moves_;
  std::array<Axis, 3> axes_;  // at state_time_
  Time state_time_{};         // of the newest frame, or of the oldest attitude that is kept
  std::optional<Time> sighted_;
  std::optional<Time> contradicted_;  // since when
  double commanded_ = 0;              // upwards
  double thrust_ = 0;                 // the same after the lag of attitude and motors
  double heading_ = 0;                // of the body in the frame
  std::optional<Time> measured_;      // time of the newest acceleration
  Eigen::Vector3d sensed_{0, 0, 0};   // the same in the frame, without gravity
  double vibration_ = 0;              // variance of its noise in an axis, m^2/s^4
  // What it measures beyond lean and thrust, in the frame, without vibration.
  Eigen::Vector3d disturbance_{0, 0, 0};
  Eigen::Vector3d steady_{0, 0, 0};  // its mean of some seconds with the pad in view
  Eigen::Quaterniond last_attitude_ = Eigen::Quaterniond::Identity();
  std::array<Input, kInputs> inputs_;
  std::size_t first_ = 0, size_ = 0;
};

}  // namespace kestrel
