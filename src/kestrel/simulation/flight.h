// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "kestrel/base/random.h"
#include "kestrel/simulation/world.h"

namespace kestrel {

// How the vehicle drives. Its body's frame: x forward, y left, z up, origin on the ground.
struct VehicleMotionOptions {
  std::string path = "figure8";  // standing, straight, circle or figure8
  double speed_mps = 4.2;        // 0 to 20; the contest: 15 km/h
  double radius_m = 15;          // of the circle; half the length of the figure of eight
  double shake_deg = 0.4;        // roll and pitch by its springs, standard deviation

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("path", self.path, "", "standing, straight, circle or figure8");
    visitor("speed_mps", self.speed_mps, "m/s", "speed; the contest's 15 km/h are 4.2");
    visitor("radius_m", self.radius_m, "m",
            "of the circle; half the length of the figure of eight");
    visitor("shake_deg", self.shake_deg, "deg", "roll and pitch on its springs");
  }
  std::vector<std::string> Validate() const;
};

// How the UAV flies over the vehicle. Altitudes are those of the body above the pattern.
struct LandingFlightOptions {
  double start_altitude_m = 12;
  double end_altitude_m = 0.6;
  double offset_m = 0.15;          // how far beside the pattern, per metre of altitude
  double sway_acceleration = 0.2;  // largest of its swaying, m/s^2, less near the pattern; the
                                   // paper's calm flight: 0.2; 8 tilts the UAV by 40 degrees
  double sway_period_s = 6;
  double attitude_noise_deg = 0.3;  // fast, small errors of the attitude control
  double yaw_rate_deg = 10;         // amplitude of its slow turning, degrees per second

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("start_altitude_m", self.start_altitude_m, "m", "above the pattern at the beginning");
    visitor("end_altitude_m", self.end_altitude_m, "m", "above the pattern at the end");
    visitor("offset_m", self.offset_m, "m/m", "how far beside the pattern, per metre of altitude");
    visitor("sway_acceleration", self.sway_acceleration, "m/s^2",
            "largest acceleration of its swaying; 8 tilts the UAV by 40 deg");
    visitor("sway_period_s", self.sway_period_s, "s", "period of its swaying");
    visitor("attitude_noise_deg", self.attitude_noise_deg, "deg", "errors of the attitude control");
    visitor("yaw_rate_deg", self.yaw_rate_deg, "deg/s", "rate of its slow turning");
  }
  std::vector<std::string> Validate() const;
};

// The vehicle's motion; starts somewhere on its path at time 0.
Motion VehicleMotion(const VehicleMotionOptions& options, Random* random);

// A position (m) as a function of time (s), two times differentiable.
using Path = std::function<Eigen::Vector3d(double time_s)>;

inline constexpr double kGravity = 9.81;  // m/s^2

// Attitude (world_from_body) of a multicopter whose thrust, as an acceleration in the world, is
// along its z axis; 'yaw' is the heading of x, rad.
Eigen::Quaterniond MulticopterAttitude(const Eigen::Vector3d& thrust, double yaw);

// The body (x forward, y left, z up) of a multicopter that follows 'position': its thrust, along z,
// is what the acceleration and gravity ask for. 'yaw' is the heading of x, rad.
Motion MulticopterMotion(const Path& position, const std::function<double(double time_s)>& yaw,
                         double attitude_noise_deg, Random* random);

// The UAV's motion over 'duration_s' from the start altitude to the end altitude above 'target'.
Motion LandingFlight(const LandingFlightOptions& options, const Path& target, double duration_s,
                     Random* random);

// A smooth random function of time: sines of random phase and of periods around 'period_s', mean 0,
// with the standard deviation 'sigma'.
std::function<double(double time_s)> Wander(double sigma, double period_s, Random* random);

}  // namespace kestrel
