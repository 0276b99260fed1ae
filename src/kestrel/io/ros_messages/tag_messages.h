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

struct ImagePointMessage {  // px
  static constexpr std::string_view kType = "apriltag_msgs/Point";
  double x = 0;
  double y = 0;

  static void Fields(auto& self, auto& wire) {
    wire("x", self.x);
    wire("y", self.y);
  }
};

struct TagMessage {
  static constexpr std::string_view kType = "apriltag_msgs/AprilTagDetection";
  std::string family;
  std::int32_t id = 0;
  std::int32_t hamming = 0;  // bits that were corrected
  float goodness = 0;
  float decision_margin = 0;
  ImagePointMessage center;
  std::array<ImagePointMessage, 4> corners;  // from the lower left, anticlockwise
  std::array<double, 9> homography{};        // from -1 to 1, y down, to the image; row by row

  static void Fields(auto& self, auto& wire) {
    wire("family", self.family);
    wire("id", self.id);
    wire("hamming", self.hamming);
    wire("goodness", self.goodness);
    wire("decision_margin", self.decision_margin);
    wire("centre", self.center);
    wire("corners", self.corners);
    wire("homography", self.homography);
  }
};

struct TagArrayMessage {
  static constexpr std::string_view kType = "apriltag_msgs/AprilTagDetectionArray";
  HeaderMessage header;
  std::vector<TagMessage> detections;

  static void Fields(auto& self, auto& wire) {
    wire("header", self.header);
    wire("detections", self.detections);
  }
};

}  // namespace kestrel
