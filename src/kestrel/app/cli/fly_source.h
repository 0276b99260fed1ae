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

// The source of a flight's images.
struct FlySource {
  std::unique_ptr<VehicleWorld> world;  // of a simulation, "sim:SCENARIO"
  std::unique_ptr<LiveSource> source;
  CameraCalibration calibration;
  double rate_hz = 0;
  bool has_poses = false;  // the source, a recording, has poses of its own
  // Other views of 'source'; null where it has none.
  SimulatedCamera* simulated = nullptr;
  ExposureActuator* actuator = nullptr;
  std::shared_ptr<Ros2Node> node;   // node that receives "dds:TOPIC",
  std::optional<RosFrames> frames;  // and the names of its frames
  bool has_true_poses = false;      // the autopilot tells the true poses of a simulated camera

  // Returns 'options' with what this source needs from the autopilot.
  AutopilotOptions Asking(AutopilotOptions options) const;
  // Poses from the autopilot. They place a simulated camera: the true poses, if there are any, else
  // the estimated ones.
  void TakePose(const PoseSample& pose);
  void TakeTruePose(const PoseSample& pose);
};

// Opens the source that the arguments name: a topic of ROS 2 ("dds:/camera/image_raw"),
// "sim:SCENARIO" with optional settings as "sim:straight,vehicle.speed_mps=4", a camera
// (/dev/video0, rtsp://..., a GStreamer pipeline), or a recording, which is played in real time,
// repeatedly when 'is_looped'. Throws InputError that says what is wrong with the source.
FlySource OpenFlySource(const SourceArguments& arguments, PixelFormat format,
                        const KestrelOptions& options, bool is_looped);

}  // namespace kestrel
