// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "kestrel/app/cli/kestrel_options.h"
#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/comms/dds/ros2_node.h"
#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/onboard/exposure_drive.h"
#include "kestrel/flight/ros/ros_results.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/simulation/autopilots/simulated_camera.h"
#include "kestrel/simulation/autopilots/vehicle_world.h"

namespace kestrel {

// Where the images of a flight come from.
struct FlySource {
  std::unique_ptr<VehicleWorld> world;  // of a simulation: "sim:SCENARIO"
  std::unique_ptr<LiveSource> source;
  CameraCalibration calibration;
  double rate_hz = 0;
  bool has_poses = false;  // the source's own: a recording
  // Of 'source', where it is such; else null.
  SimulatedCamera* simulated = nullptr;
  ExposureActuator* actuator = nullptr;
  std::shared_ptr<Ros2Node> node;   // "dds:TOPIC": where it is heard,
  std::optional<RosFrames> frames;  // and what its frames are called
  bool has_true_poses = false;      // the autopilot tells where a simulated camera truly is

  // What this asks of the autopilot, beside 'options'.
  AutopilotOptions Asking(AutopilotOptions options) const;
  // Poses of the autopilot: a simulated camera is where the true ones say, else where these do.
  void TakePose(const PoseSample& pose);
  void TakeTruePose(const PoseSample& pose);
};

// Opens what the arguments name: a topic of ROS 2 ("dds:/camera/image_raw"), "sim:SCENARIO" with
// further settings as "sim:straight,vehicle.speed_mps=4", a camera (/dev/video0, rtsp://..., a
// GStreamer pipeline), or a recording, played in real time, again and again when 'is_looped'.
// Throws InputError with what is wrong with it.
FlySource OpenFlySource(const SourceArguments& arguments, PixelFormat format,
                        const KestrelOptions& options, bool is_looped);

}  // namespace kestrel
