// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// Errors of the UAV's navigation: position, attitude, clock, and mount of the camera.
struct NavigationOptions {
  double rate_hz = 100;
  double origin_x_m = 0;
  double origin_y_m = 0;
  double world_yaw_deg = 0;
  double position_noise_m = 0.01;
  double position_drift_m = 0.02;
  double position_bias_m = 0.02;
  double attitude_noise_deg = 0.15;
  double attitude_bias_deg = 0.2;
  double clock_offset_min_s = -0.1;
  double clock_offset_max_s = 0.3;
  double mount_error_deg = 1;
  double vibration_deg = 0;
  double vibration_hz = 90;

  static void Visit(auto& self, auto&& visit) {
    visit("rate_hz", self.rate_hz, Range{1, 1000}, "poses per second");
    visit("origin_x_m", self.origin_x_m, Range{-1000, 1000},
          "x of the world's origin in the navigation's world");
    visit("origin_y_m", self.origin_y_m, Range{-1000, 1000},
          "y of the world's origin in the navigation's world");
    visit("world_yaw_deg", self.world_yaw_deg, Range{-180, 180},
          "direction of the world's x axis in the navigation's world, from x to y");
    visit("position_noise_m", self.position_noise_m, Range{0, 10},
          "noise of the position, per axis");
    visit("position_drift_m", self.position_drift_m, Range{0, 10},
          "slow error of the position, per axis");
    visit("position_bias_m", self.position_bias_m, Range{0, 10},
          "constant error of the position, per axis");
    visit("attitude_noise_deg", self.attitude_noise_deg, Range{0, 10},
          "noise of the attitude, per axis");
    visit("attitude_bias_deg", self.attitude_bias_deg, Range{0, 10},
          "constant error of the attitude");
    visit("clock_offset_min_s", self.clock_offset_min_s, Range{-10, 10},
          "least clock offset drawn");
    visit("clock_offset_max_s", self.clock_offset_max_s, "largest clock offset drawn");
    visit("mount_error_deg", self.mount_error_deg, Range{0, 20}, "error of the mount, per axis");
    visit("vibration_deg", self.vibration_deg, Range{0, 5}, "vibration of the camera on its mount");
    visit("vibration_hz", self.vibration_hz, Range{1, 500}, "frequency of the vibration");
  }
  std::vector<std::string> Validate() const;
};

// The errors of one flight, drawn from NavigationOptions.
struct NavigationErrors {
  double clock_offset_s = 0;  // t_nav = t_image + offset
  // True mount = Rz(yaw) Ry(pitch) Rx(roll) nominal mount, in the body frame.
  double mount_roll_deg = 0;
  double mount_pitch_deg = 0;
  double mount_yaw_deg = 0;

  RigidTransform TrueMount(const RigidTransform& nominal) const;
};
NavigationErrors DrawNavigationErrors(const NavigationOptions& options, Random* random);

// The navigation's reports of a flight, pose by pose. A copy continues independently.
class NavigationSensor {
 public:
  NavigationSensor(const NavigationOptions& options, const NavigationErrors& errors, Random random);

  // Returns the next pose: of 'time_s', stamped with the navigation's own clock.
  PoseSample Report(double time_s, RigidTransform world_from_body);

  // Returns all poses from 'begin_s' on at the navigation's rate; the last is not before 'end_s'.
  std::vector<PoseSample> ReportAll(const Motion& world_from_body, double begin_s, double end_s);

 private:
  NavigationOptions options_;
  NavigationErrors errors_;
  Random random_;
  RigidTransform navigation_from_world_;
  Eigen::Vector3d bias_;
  Eigen::Quaterniond turn_;  // constant error of the attitude
  std::array<std::function<double(double time_s)>, 3> drift_;
};

// Rotation of the camera on its mount (camera_from_still_camera) as a function of time (s).
std::function<Eigen::Quaterniond(double time_s)> Vibration(const NavigationOptions& options,
                                                           Random* random);

}  // namespace kestrel
