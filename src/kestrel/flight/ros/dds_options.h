// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace kestrel {

// Names of the frames of results on topics, and how far the prediction goes.
struct RosResultOptions {
  std::string body_frame = "base_link";           // of the UAV, which the camera is fixed to
  std::string pattern_frame = "landing_pattern";  // of tf, for the detected pattern
  std::string target_frame = "landing_target";    // frame of the track's velocity
  bool publish_tf = true;
  double prediction_s = 2;
  double prediction_step_s = 0.1;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("body_frame", self.body_frame, "", "of the UAV, which the camera is fixed to");
    visitor("pattern_frame", self.pattern_frame, "", "name of the detected pattern in tf");
    visitor("target_frame", self.target_frame, "", "name of the frame that moves with the target");
    visitor("publish_tf", self.publish_tf, "", "whether tf is told of pattern, UAV and mount");
    visitor("prediction_s", self.prediction_s, "s", "how far ahead the prediction goes");
    visitor("prediction_step_s", self.prediction_step_s, "s", "between its poses");
  }
  std::vector<std::string> Validate() const;
};

// Options of Kestrel's part in a system of ROS 2, see docs/ros2.md.
struct DdsOptions : RosResultOptions {
  std::string node = "kestrel";  // name of the node; its topics are below it
  // Distribution of ROS: since Iron, nodes list each other in messages that Humble does not know.
  std::string distribution = "jazzy";
  std::string camera_frame = "camera_optical_frame";  // a dds: source has its own
  std::string world_frame = "map";                    // a dds: source has its own
  double wait_s = 10;  // longest wait for images, camera_info and mount of a dds: source

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("node", self.node, "", "name of the node; its topics are below it");
    visitor("distribution", self.distribution, "",
            "of ROS 2 that is to list the node: humble or a later one");
    visitor("camera_frame", self.camera_frame, "", "of the camera, where it is no dds: source");
    visitor("world_frame", self.world_frame, "", "of the world, where it is no dds: source");
    RosResultOptions::Visit(self, visitor);
    visitor("wait_s", self.wait_s, "s", "for the images, camera_info and mount of a dds: source");
  }
  std::vector<std::string> Validate() const;

  bool is_humble() const { return distribution == "humble"; }
};

}  // namespace kestrel
