// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace kestrel {

// Gains of a velocity control that adds the commanded acceleration to its own, as PX4's does:
//   thrust = a_command + p slip + i integral(slip) - d a,  slip = v_command - v.
// `fly` reads them from the autopilot's parameters; they are no options.
struct VelocityControl {
  double p =
      0;  // 1/s; 0: the autopilot shapes its commands, and no acceleration reaches the thrust
  double i = 0;  // 1/s^2
  double d = 0;

  bool takes_acceleration() const { return p > 0; }
  std::vector<std::string> Validate() const;
};

// The horizontal acceleration that the air takes from a UAV: drag times its velocity, less a part
// by the wind (m/s^2).
struct AirForce {
  double drag = 0;  // 1/s
  Eigen::Vector2d by_wind{0, 0};

  Eigen::Vector2d At(const Eigen::Vector2d& velocity) const { return drag * velocity - by_wind; }
};

// Estimates the acceleration that has to be commanded in addition to the one that is wanted, so
// that the velocity control has nothing to do: the air's force, less what the control's integral
// gives already. A disturbance observer: the difference between the thrust that the control law
// gives and the acceleration that is measured, through a low pass. The air's force at the present
// velocity and the change of the integral by the control law are known and pass it without delay.
// Reference: Ohnishi, Shibata, Murakami: Motion control for advanced mechatronics, IEEE/ASME
// Transactions on Mechatronics 1 (1), 1996.
class DisturbanceObserver {
 public:
  explicit DisturbanceObserver(const VelocityControl& control) : control_(control) {}

  // Means over a moment, m/s and m/s^2.
  struct Sample {
    Eigen::Vector2d velocity{0, 0};
    Eigen::Vector2d acceleration{0, 0};
    Eigen::Vector2d slip{0, 0};       // as the control saw it when it caused this acceleration
    Eigen::Vector2d commanded{0, 0};  // acceleration, likewise
  };
  // Takes the next sample, 'seconds' after the one before. 'delay_s': from a command to its effect.
  void Observe(const Sample& sample, double seconds, double delay_s);

  // Takes a better estimate of the air's force for a UAV with 'velocity'.
  void SetAir(const AirForce& air, const Eigen::Vector2d& velocity);

  // Returns the acceleration to add for a UAV that is to fly with 'velocity' and 'acceleration'.
  Eigen::Vector2d FeedForward(const Eigen::Vector2d& velocity,
                              const Eigen::Vector2d& acceleration) const;

 private:
  VelocityControl control_;
  AirForce air_;
  Eigen::Vector2d rest_{0, 0};  // what the air's force does not explain, above all the integral
};

}  // namespace kestrel
