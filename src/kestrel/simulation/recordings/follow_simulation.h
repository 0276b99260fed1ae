// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/simulation/recordings/recording_plan.h"
#include "kestrel/simulation/recordings/simulated_flight.h"
#include "kestrel/simulation/scene/follow_scene.h"
#include "kestrel/simulation/scene/vehicle_motion.h"

namespace kestrel {

// Flight of the UAV beside the thing, with the nose towards it.
struct FollowFlightOptions {
  double distance_m = 12;
  double height_m = 8;
  double swing_deg = 20;
  double turn_dps = 0;
  double turn_deg = 12;
  double attitude_noise_deg = 0.4;

  static void Visit(auto& self, auto&& visit) {
    visit("distance_m", self.distance_m, Range{1, 200}, "horizontal distance from the thing");
    visit("height_m", self.height_m, Range{5, 200}, "height above the ground");
    visit("swing_deg", self.swing_deg, Range{0, 180},
          "slow change of the side from which the thing is seen");
    visit("turn_dps", self.turn_dps, Range{0, 360},
          "fastest turn of the nose to and fro past the thing; 0: none");
    visit("turn_deg", self.turn_deg, Range{1, 90}, "how far it turns, to either side");
    visit("attitude_noise_deg", self.attitude_noise_deg, Range{0, 10},
          "errors of the attitude control");
  }
};

// A simulated flight beside a thing that is followed, from the motion to the sensor.
struct FollowSimulationOptions {
  FollowSimulationOptions();

  FlightRecordingOptions recording;
  FollowFlightOptions flight;
  VehicleMotionOptions motion;
  FollowedThingOptions thing;
  FollowSurroundings surroundings;
  double lost_frames = 0;

  static void Visit(auto& self, auto&& visit) {
    visit.Group(self.recording);
    visit.Group("flight", self.flight);
    visit.Group("motion", self.motion);
    visit.Group("thing", self.thing);
    visit.Group("ground", self.surroundings.ground);
    visit.Group("light", self.surroundings.light);
    visit("lost_frames", self.lost_frames, Range{0, 0.9}, "part of the images that is lost");
  }
  std::vector<std::string> Validate() const;
};

// Plans the recording: everything is made except the images. 'camera' has a mount (the nominal
// one). The same arguments give the same recording. Throws InputError when options are not valid.
RecordingPlan PlanFollow(const FollowSimulationOptions& options, const CameraCalibration& camera,
                         std::uint64_t seed);

}  // namespace kestrel
