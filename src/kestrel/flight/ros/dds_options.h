// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/core/base/limits.h"

namespace kestrel {

// Options of Kestrel's part in a system of ROS 2, see docs/ros2.md.
struct DdsOptions {
  std::string node = "kestrel";
  std::string distribution = "jazzy";
  std::string camera_frame = "camera_optical_frame";
  std::string world_frame = "map";
  std::string body_frame = "base_link";
  std::string pattern_frame = "landing_pattern";
  std::string target_frame = "landing_target";
  bool publish_tf = true;
  bool apriltag_topics = false;
  double prediction_s = 2;
  double prediction_step_s = 0.1;
  double wait_s = 10;

  static void Visit(auto& self, auto&& visit) {
    visit("node", self.node, "name of the node; its topics are below it");
    visit("distribution", self.distribution,
          OneOf{{"humble", "iron", "jazzy", "kilted", "lyrical", "rolling"}},
          "distribution of ROS 2 that lists the node");
    visit("camera_frame", self.camera_frame, "frame of the camera, if it is not a dds: source");
    visit("world_frame", self.world_frame,
          "frame of the world, if the camera is not a dds: source");
    visit("body_frame", self.body_frame, "frame of the UAV, to which the camera is fixed");
    visit("pattern_frame", self.pattern_frame, "frame of the detected pattern");
    visit("target_frame", self.target_frame, "frame that moves with the target");
    visit("publish_tf", self.publish_tf, "pattern, UAV and mount are published on tf");
    visit("apriltag_topics", self.apriltag_topics,
          "tags are also published as apriltag_ros publishes them: on /detections and on tf");
    visit("prediction_s", self.prediction_s, Range{0, 60}, "horizon of the prediction");
    visit("prediction_step_s", self.prediction_step_s, Range{0.01, 60},
          "interval between the poses of the prediction");
    visit("wait_s", self.wait_s, Range{0, 600},
          "longest wait for the images, camera_info and mount of a dds: source");
  }
  std::vector<std::string> Validate() const;

  bool is_humble() const { return distribution == "humble"; }
};

}  // namespace kestrel
