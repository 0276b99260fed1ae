// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/ros_node/node_task.h"

#include "kestrel/app/ros_node/hunt_task.h"
#include "kestrel/app/ros_node/landing_task.h"

namespace kestrel {

std::unique_ptr<NodeTask> MakeNodeTask(const CameraCalibration& calibration,
                                       const std::optional<HuntedObjects>& objects,
                                       const NodeOptions& options, const NodeFrames& frames,
                                       NodeConnection* connection) {
  if (objects)
    return std::make_unique<HuntTask>(calibration, *objects, options, frames, connection);
  return std::make_unique<LandingTask>(calibration, options, frames, connection);
}

}  // namespace kestrel
