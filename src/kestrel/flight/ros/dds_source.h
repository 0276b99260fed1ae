// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "kestrel/comms/dds/ros2_node.h"
#include "kestrel/flight/onboard/open_live_source.h"
#include "kestrel/flight/ros/dds_options.h"
#include "kestrel/flight/ros/ros_results.h"

namespace kestrel {

// Opens the node that the options name. Throws InputError when that cannot be.
std::shared_ptr<Ros2Node> OpenRos2Node(int domain, const DdsOptions& options);

// The scheme "dds:TOPIC" of live sources: images of ROS 2. It keeps the node, for results that go
// back by the same one. Must outlive the scheme.
class DdsSource {
 public:
  using OpenNode = std::function<std::shared_ptr<Ros2Node>()>;

  // 'open_node': called when a topic is opened. 'notify': receives messages for the user.
  DdsSource(const DdsOptions& options, OpenNode open_node,
            std::function<void(const std::string&)> notify);

  // The source takes calibration and mount from the topics beside the images, unless the user has
  // given them. It throws InputError as DdsCamera does.
  SourceScheme Scheme();

  // The node of the source; null: none was opened.
  const std::shared_ptr<Ros2Node>& node() const { return node_; }
  // The names of the source's frames; nothing when none was opened.
  const std::optional<RosFrames>& frames() const { return frames_; }

 private:
  OpenedLiveSource Open(const LiveSourceChoice& choice);

  DdsOptions options_;
  OpenNode open_node_;
  std::function<void(const std::string&)> notify_;
  std::shared_ptr<Ros2Node> node_;
  std::optional<RosFrames> frames_;
};

}  // namespace kestrel
