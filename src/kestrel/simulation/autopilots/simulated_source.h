// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/onboard/open_live_source.h"
#include "kestrel/simulation/autopilots/simulated_camera.h"
#include "kestrel/simulation/autopilots/vehicle_world.h"

namespace kestrel {

// The scheme "sim:SCENARIO" of live sources, with optional settings as
// "sim:straight,vehicle.speed_mps=4": a camera, or two, over a simulated world. It owns the world,
// which a simulated autopilot shares. Must outlive the scheme and its source.
class SimulatedSource {
 public:
  // 'target': the pad on the vehicle, unless the settings of the source name another.
  SimulatedSource(const SimulatedCameraOptions& options, const TargetOptions& target,
                  std::uint64_t seed)
      : options_(options), target_(target), seed_(seed) {}

  // Whether a source of this name is one of this scheme.
  static bool IsNamed(std::string_view uri);

  // The source has the simulated camera's calibration, or the one that the user gives; a file
  // without a mount gets the simulated camera's, one with a gimbal puts the camera on it. It throws
  // InputError for a scenario or settings that do not exist, and for a calibration of another image
  // size.
  SourceScheme Scheme();

  // The world; a standing vehicle if no source was opened.
  VehicleWorld* World();

  // True when the camera is on a gimbal, which only a simulated autopilot has.
  bool has_gimbal() const { return !cameras_.empty() && cameras_[0]->calibration().gimbal; }
  // The zoom of the camera, and its lens before it does.
  ZoomOptions zoom() const { return cameras_.empty() ? ZoomOptions() : options_.zoom; }
  CameraIntrinsics lens() const {
    return cameras_.empty() ? CameraIntrinsics() : cameras_[0]->calibration().intrinsics;
  }

  // Poses from the autopilot. They place the camera: the true poses, if there are any, else the
  // estimated ones.
  void TakePose(const PoseSample& pose);
  void TakeTruePose(const PoseSample& pose);

  // Returns 'options' with what the camera needs from the autopilot.
  AutopilotOptions Asking(AutopilotOptions options) const;

 private:
  OpenedLiveSource Open(const LiveSourceChoice& choice);
  void AddSecond(Time start, OpenedLiveSource* opened);

  SimulatedCameraOptions options_;
  TargetOptions target_;
  std::uint64_t seed_;
  std::unique_ptr<VehicleWorld> world_;
  std::vector<SimulatedCamera*> cameras_;  // those that the source has; empty: none was opened
  bool has_true_poses_ = false;
};

}  // namespace kestrel
