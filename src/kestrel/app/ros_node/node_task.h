// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "kestrel/app/ros_node/node_connection.h"
#include "kestrel/app/ros_node/node_files.h"
#include "kestrel/app/ros_node/node_options.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

// The names of the frames that results are in.
struct NodeFrames {
  std::string camera;
  std::optional<std::string> world;  // where there are poses
};

// What the node does with images: a pipeline, and what is published of it. One thread at a time.
class NodeTask {
 public:
  virtual ~NodeTask() = default;

  // How much later than a frame's time, on the navigation's clock, the last pose is that it needs.
  virtual Duration pose_lead() const = 0;

  virtual void AddPose(const PoseSample& pose) = 0;

  struct Found {
    bool something = false;
    Duration detect_time{};  // of Detect alone
  };
  // Publishes the detections of a frame.
  virtual Found PublishDetections(const Frame& frame) = 0;
  // Publishes what else the same frame said.
  virtual void PublishRest(const Frame& frame) = 0;

  // Goes on with options that UpdateOptions took over, and forgets nothing.
  virtual void Update(const NodeOptions& options) = 0;

  // Publishes the map as it is after the last frame, unless it was published.
  virtual void PublishMap() = 0;
  // Writes the map to the options' folder, and says in words what it wrote. Throws InputError when
  // there is no map or it cannot be written.
  virtual std::string SaveMap() = 0;
};

// The hunt for 'objects', or the landing pattern where there are none. Throws InputError when
// calibration or options are not valid.
std::unique_ptr<NodeTask> MakeNodeTask(const CameraCalibration& calibration,
                                       const std::optional<HuntedObjects>& objects,
                                       const NodeOptions& options, const NodeFrames& frames,
                                       NodeConnection* connection);

}  // namespace kestrel
