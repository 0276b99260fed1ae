// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/gimbal_angles.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/simulation/scene/motion.h"

namespace kestrel {

struct GimbalMotorOptions {
  double lag_s = 0.1;
  double max_turn_dps = 90;
  double noise_deg = 0.05;

  static void Visit(auto& self, auto&& visit) {
    visit("lag_s", self.lag_s, Range{0.01, 2}, "time constant with which it follows its target");
    visit("max_turn_dps", self.max_turn_dps, Range{1, 1000}, "fastest turn of a motor");
    visit("noise_deg", self.noise_deg, Range{0, 10}, "noise of the reported attitude, per axis");
  }
};

// A gimbal with two motors, and what it reports.
struct GimbalOptions : GimbalMotorOptions {
  double rate_hz = 0;
  double stamp_delay_s = 0.02;
  std::string yaw_frame = "vehicle";

  static void Visit(auto& self, auto&& visit) {
    visit("rate_hz", self.rate_hz, Range{0, 200},
          "reports per second; 0: the camera is fixed to the UAV");
    GimbalMotorOptions::Visit(self, visit);
    visit("stamp_delay_s", self.stamp_delay_s, Range{-1, 1},
          "time after the attitude at which its report is stamped");
    visit("yaw_frame", self.yaw_frame, OneOf{{"earth", "vehicle"}}, "frame of the reported yaw");
  }
  bool is_there() const { return rate_hz > 0; }
};

// Returns the angles 'seconds' later of motors that turn to 'aim'.
GimbalAngles Turned(const GimbalMotorOptions& motors, const GimbalAngles& angles,
                    const GimbalAngles& aim, double seconds);

// Returns a rotation as it is reported.
Eigen::Quaterniond WithNoise(const GimbalMotorOptions& motors, const Eigen::Quaterniond& rotation,
                             Random* random);

// A gimbal on a flight, which looks at a point of the world and straight down where that is nearly
// below. Roll is 0. Thread-safe.
class SimulatedGimbal {
 public:
  // Flies from 'begin_s' to 'end_s'. 'body_from_pivot': its place.
  SimulatedGimbal(const GimbalOptions& options, Motion world_from_body,
                  const RigidTransform& body_from_pivot, const Path& target, double begin_s,
                  double end_s);

  // Returns the pose of the platform in the world.
  RigidTransform WorldFromPlatform(double time_s) const;

  // Returns all reports, stamped on the clock of the navigation: 'clock_offset_s' after that of the
  // images. The x axis of the world stands at 'world_yaw_rad' in the world of the navigation.
  std::vector<GimbalSample> Reports(double clock_offset_s, double world_yaw_rad,
                                    Random random) const;

  // Returns the true attitudes in the world, 'rate_hz' a second, on the clock of the images.
  std::vector<GimbalSample> Truth(double rate_hz) const;

 private:
  double end_s() const;
  Eigen::Quaterniond Attitude(double time_s) const;

  GimbalOptions options_;
  Motion world_from_body_;
  RigidTransform body_from_pivot_;
  double begin_s_;
  std::vector<GimbalAngles> angles_;  // in the world, at kSteps_hz
};

}  // namespace kestrel
