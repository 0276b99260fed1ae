// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "kestrel/comms/dds/ros2_node.h"
#include "kestrel/flight/onboard/open_live_source.h"
#include "kestrel/flight/ros/dds_camera.h"
#include "kestrel/flight/ros/dds_options.h"
#include "kestrel/flight/ros/ros_results.h"

namespace kestrel {

// Opens the node that the options name. Throws InputError when that cannot be.
std::shared_ptr<Ros2Node> OpenRos2Node(int domain, const DdsOptions& options);

// The scheme "dds:TOPIC" of live sources: images of ROS 2. It keeps the node, for results that go
// back by the same one. Opened again, it adds a further camera to the node: the poses, the body's
// frame and the clock are then those of the first. Must outlive the scheme.
class DdsSource {
 public:
  using OpenNode = std::function<std::shared_ptr<Ros2Node>()>;

  // 'open_node': called when a topic is opened. 'notify': receives messages for the user.
  DdsSource(const DdsOptions& options, OpenNode open_node,
            std::function<void(const std::string&)> notify);

  // The source takes calibration and mount from the topics beside the images, unless the user has
  // given them. It throws InputError as DdsCamera does, and when the only camera_info is another
  // camera's.
  SourceScheme Scheme();

  // The node of the source; null: none was opened.
  const std::shared_ptr<Ros2Node>& node() const { return node_; }
  // The names of the source's frames; nothing when none was opened.
  const std::optional<RosFrames>& frames() const { return frames_; }

 private:
  OpenedLiveSource Open(const LiveSourceChoice& choice);
  DdsCameraOptions CameraOptions(const LiveSourceChoice& choice);
  void RequireOwnLens(const DdsCamera& camera, const LiveSourceChoice& choice);
  void NoteFrames(const DdsCamera& camera);

  DdsOptions options_;
  OpenNode open_node_;
  std::function<void(const std::string&)> notify_;
  std::shared_ptr<Ros2Node> node_;
  std::optional<RosFrames> frames_;
  std::string body_frame_;            // of the UAV, as the first camera's poses name it
  std::set<std::string> used_infos_;  // topics of camera_info
  std::size_t inboxes_ = 0;           // of the node, in use
};

}  // namespace kestrel
