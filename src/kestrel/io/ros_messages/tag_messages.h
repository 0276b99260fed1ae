// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/io/ros_messages/messages.h"

namespace kestrel {

// The messages of apriltag_ros in ROS 2, by the same rules as in messages.h.

struct ImagePointMessage {  // apriltag_msgs/Point, px
  double x = 0;
  double y = 0;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.x);
    wire(self.y);
  }
};

struct TagMessage {  // apriltag_msgs/AprilTagDetection
  std::string family;
  std::int32_t id = 0;
  std::int32_t hamming = 0;  // bits that were corrected
  float goodness = 0;
  float decision_margin = 0;
  ImagePointMessage center;
  std::array<ImagePointMessage, 4> corners;  // from the lower left, anticlockwise
  std::array<double, 9> homography{};        // from -1 to 1, y down, to the image; row by row

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.family);
    wire(self.id);
    wire(self.hamming);
    wire(self.goodness);
    wire(self.decision_margin);
    wire(self.center);
    for (auto& corner : self.corners) wire(corner);
    for (auto& number : self.homography) wire(number);
  }
};

struct TagArrayMessage {
  static constexpr std::string_view kType = "apriltag_msgs/AprilTagDetectionArray";
  HeaderMessage header;
  std::vector<TagMessage> detections;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.header);
    wire.List(self.detections);
  }
};

}  // namespace kestrel
