// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/core/base/time.h"

namespace kestrel {

// The standard messages of ROS that Kestrel reads and writes. Each lists its fields once, in the
// order of their serialization, by
//
//   template <class Self, class Wire> static void Fields(Self& self, Wire& wire);
//
// With this serialization.h reads and writes them in the formats of ROS 1 and of ROS 2.

struct HeaderMessage {
  std::uint32_t sequence = 0;  // ROS 1 only
  Time stamp;
  std::string frame_id;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire.OfRos1(self.sequence);
    wire(self.stamp);
    wire(self.frame_id);
  }
};

struct ImageMessage {
  static constexpr std::string_view kType = "sensor_msgs/Image";
  HeaderMessage header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding;
  std::uint8_t is_bigendian = 0;
  std::uint32_t step = 0;  // bytes per row
  std::string_view data;   // points into the serialized message

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.header);
    wire(self.height);
    wire(self.width);
    wire(self.encoding);
    wire(self.is_bigendian);
    wire(self.step);
    wire.ByteList(self.data);
  }
};

struct CompressedImageMessage {
  static constexpr std::string_view kType = "sensor_msgs/CompressedImage";
  HeaderMessage header;
  std::string format;     // "jpeg", "bgr8; jpeg compressed bgr8", ...
  std::string_view data;  // points into the serialized message

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.header);
    wire(self.format);
    wire.ByteList(self.data);
  }
};

struct RegionOfInterestMessage {
  std::uint32_t x_offset = 0;
  std::uint32_t y_offset = 0;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::uint8_t do_rectify = 0;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.x_offset);
    wire(self.y_offset);
    wire(self.height);
    wire(self.width);
    wire(self.do_rectify);
  }
};

struct CameraInfoMessage {
  static constexpr std::string_view kType = "sensor_msgs/CameraInfo";
  HeaderMessage header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string distortion_model;
  std::vector<double> d;
  std::array<double, 9> k{};  // row by row, like the next two
  std::array<double, 9> r{};
  std::array<double, 12> p{};
  std::uint32_t binning_x = 0;
  std::uint32_t binning_y = 0;
  RegionOfInterestMessage roi;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.header);
    wire(self.height);
    wire(self.width);
    wire(self.distortion_model);
    wire.List(self.d);
    for (auto& number : self.k) wire(number);
    for (auto& number : self.r) wire(number);
    for (auto& number : self.p) wire(number);
    wire(self.binning_x);
    wire(self.binning_y);
    wire(self.roi);
  }
};

struct Vector3Message {  // geometry_msgs/Point and Vector3
  double x = 0;
  double y = 0;
  double z = 0;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.x);
    wire(self.y);
    wire(self.z);
  }
};

struct QuaternionMessage {
  double x = 0;
  double y = 0;
  double z = 0;
  double w = 1;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.x);
    wire(self.y);
    wire(self.z);
    wire(self.w);
  }
};

struct PoseMessage {  // geometry_msgs/Pose and Transform
  Vector3Message position;
  QuaternionMessage orientation;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.position);
    wire(self.orientation);
  }
};

struct TwistMessage {
  Vector3Message linear;   // m/s
  Vector3Message angular;  // rad/s

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.linear);
    wire(self.angular);
  }
};

struct PoseStampedMessage {
  static constexpr std::string_view kType = "geometry_msgs/PoseStamped";
  HeaderMessage header;
  PoseMessage pose;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.header);
    wire(self.pose);
  }
};

struct PoseWithCovarianceStampedMessage {
  static constexpr std::string_view kType = "geometry_msgs/PoseWithCovarianceStamped";
  HeaderMessage header;
  PoseMessage pose;
  std::array<double, 36> covariance{};  // x, y, z, rotations about x, y, z; row by row

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.header);
    wire(self.pose);
    for (auto& number : self.covariance) wire(number);
  }
};

struct TransformStampedMessage {
  static constexpr std::string_view kType = "geometry_msgs/TransformStamped";
  HeaderMessage header;
  std::string child_frame_id;
  PoseMessage transform;  // pose of the child in the header's frame

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.header);
    wire(self.child_frame_id);
    wire(self.transform);
  }
};

struct TfMessage {
  static constexpr std::string_view kType = "tf2_msgs/TFMessage";
  std::vector<TransformStampedMessage> transforms;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire.List(self.transforms);
  }
};

struct OdometryMessage {
  static constexpr std::string_view kType = "nav_msgs/Odometry";
  HeaderMessage header;
  std::string child_frame_id;
  PoseMessage pose;
  std::array<double, 36> pose_covariance{};
  TwistMessage twist;  // in the child's frame
  std::array<double, 36> twist_covariance{};

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.header);
    wire(self.child_frame_id);
    wire(self.pose);
    for (auto& number : self.pose_covariance) wire(number);
    wire(self.twist);
    for (auto& number : self.twist_covariance) wire(number);
  }
};

}  // namespace kestrel
