// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace kestrel {

// Options of Kestrel's part in a system of ROS 2, see docs/ros2.md.
struct DdsOptions {
  std::string node = "kestrel";  // name of the node; its topics are below it
  // Distribution of ROS: since Iron, nodes list each other in messages that Humble does not know.
  std::string distribution = "jazzy";
  std::string camera_frame = "camera_optical_frame";  // a dds: source has its own
  std::string world_frame = "map";                    // a dds: source has its own
  std::string body_frame = "base_link";               // of the UAV, which the camera is fixed to
  std::string pattern_frame = "landing_pattern";      // of tf, for the detected pattern
  std::string target_frame = "landing_target";        // frame of the track's velocity
  bool publish_tf = true;
  bool apriltag_topics = false;
  double prediction_s = 2;
  double prediction_step_s = 0.1;
  double wait_s = 10;  // longest wait for images, camera_info and mount of a dds: source

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("node", self.node, "", "name of the node; its topics are below it");
    visitor("distribution", self.distribution, "",
            "distribution of ROS 2 that lists the node: humble or a later one");
    visitor("camera_frame", self.camera_frame, "",
            "frame of the camera, if it is not a dds: source");
    visitor("world_frame", self.world_frame, "",
            "frame of the world, if the camera is not a dds: source");
    visitor("body_frame", self.body_frame, "", "frame of the UAV, to which the camera is fixed");
    visitor("pattern_frame", self.pattern_frame, "", "frame of the detected pattern");
    visitor("target_frame", self.target_frame, "", "frame that moves with the target");
    visitor("publish_tf", self.publish_tf, "", "pattern, UAV and mount are published on tf");
    visitor("apriltag_topics", self.apriltag_topics, "",
            "tags are also published as apriltag_ros publishes them: on /detections and on tf");
    visitor("prediction_s", self.prediction_s, "s", "horizon of the prediction");
    visitor("prediction_step_s", self.prediction_step_s, "s",
            "interval between the poses of the prediction");
    visitor("wait_s", self.wait_s, "s",
            "longest wait for the images, camera_info and mount of a dds: source");
  }
  std::vector<std::string> Validate() const;

  bool is_humble() const { return distribution == "humble"; }
};

}  // namespace kestrel
