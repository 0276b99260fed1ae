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

// Names of the frames of the results.
struct NodeFrames {
  std::string camera;
  std::optional<std::string> world;  // if there are poses
};

// The node's work on images: a pipeline and the publication of its results. One thread at a time.
class NodeTask {
 public:
  virtual ~NodeTask() = default;

  // Time from a frame's time to the last pose that it needs, on the navigation's clock.
  virtual Duration pose_lead() const = 0;

  virtual void AddPose(const PoseSample& pose) = 0;

  struct Found {
    bool something = false;
    Duration detect_time{};  // of Detect alone
  };
  // Processes a frame and publishes its detections.
  virtual Found PublishDetections(const Frame& frame) = 0;
  // Publishes the other results of the same frame.
  virtual void PublishRest(const Frame& frame) = 0;

  // Continues with options that UpdateOptions has taken over; track and map stay.
  virtual void Update(const NodeOptions& options) = 0;

  // Publishes the map as of the last frame, unless it has been published.
  virtual void PublishMap() = 0;
  // Writes the map to the options' folder and returns a text that says what it wrote. Throws
  // InputError when there is no map or it cannot be written.
  virtual std::string SaveMap() = 0;
};

// Makes the task of the hunt for 'objects' or, without objects, of the landing. Throws InputError
// when calibration or options are not valid.
std::unique_ptr<NodeTask> MakeNodeTask(const CameraCalibration& calibration,
                                       const std::optional<HuntedObjects>& objects,
                                       const NodeOptions& options, const NodeFrames& frames,
                                       NodeConnection* connection);

}  // namespace kestrel
