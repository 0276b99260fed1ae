// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/core/base/time.h"

namespace kestrel {

// The standard messages of ROS that Kestrel reads and writes. Each has the name of its type, and
// lists its fields once, in the order of their serialization, by
//
//   static constexpr std::string_view kType = "package/Name";
//   static void Fields(auto& self, auto& wire) {
//     wire("x", self.x);
//   }
//
// With this serialization.h reads and writes them in the formats of ROS 1 and of ROS 2, and
// type_description.h has their definitions, from which checksums, hashes and IDL follow. A field is
// a number, bool, enumeration (a byte), text, Time, a message, bytes (std::string_view, which
// points into the serialized message), or an array or list of these. Constants of a type are
// lines of its definition, kConstants.

template <class Type>
concept RosMessage = requires {
  { Type::kType } -> std::convertible_to<std::string_view>;
};

// The name of a field, which ROS 1 may write otherwise.
struct FieldName {
  // NOLINTNEXTLINE(google-explicit-constructor)
  constexpr FieldName(const char* name) : ros1(name), ros2(name) {}
  constexpr FieldName(const char* in_ros1, const char* in_ros2) : ros1(in_ros1), ros2(in_ros2) {}

  const char* ros1;
  const char* ros2;
};

// A text of at most kMax bytes.
template <std::size_t kMax>
struct BoundedText : std::string {};

// The type of a Time in ROS 2.
struct TimeMessage {
  static constexpr std::string_view kType = "builtin_interfaces/Time";
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;

  static void Fields(auto& self, auto& wire) {
    wire("sec", self.sec);
    wire("nanosec", self.nanosec);
  }
};

struct HeaderMessage {
  static constexpr std::string_view kType = "std_msgs/Header";
  std::uint32_t sequence = 0;  // ROS 1 only
  Time stamp;
  std::string frame_id;

  static void Fields(auto& self, auto& wire) {
    wire.OfRos1("seq", self.sequence);
    wire("stamp", self.stamp);
    wire("frame_id", self.frame_id);
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
  std::string_view data;

  static void Fields(auto& self, auto& wire) {
    wire("header", self.header);
    wire("height", self.height);
    wire("width", self.width);
    wire("encoding", self.encoding);
    wire("is_bigendian", self.is_bigendian);
    wire("step", self.step);
    wire("data", self.data);
  }
};

struct CompressedImageMessage {
  static constexpr std::string_view kType = "sensor_msgs/CompressedImage";
  HeaderMessage header;
  std::string format;  // "jpeg", "bgr8; jpeg compressed bgr8", ...
  std::string_view data;

  static void Fields(auto& self, auto& wire) {
    wire("header", self.header);
    wire("format", self.format);
    wire("data", self.data);
  }
};

struct RegionOfInterestMessage {
  static constexpr std::string_view kType = "sensor_msgs/RegionOfInterest";
  std::uint32_t x_offset = 0;
  std::uint32_t y_offset = 0;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  bool do_rectify = false;

  static void Fields(auto& self, auto& wire) {
    wire("x_offset", self.x_offset);
    wire("y_offset", self.y_offset);
    wire("height", self.height);
    wire("width", self.width);
    wire("do_rectify", self.do_rectify);
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

  static void Fields(auto& self, auto& wire) {
    wire("header", self.header);
    wire("height", self.height);
    wire("width", self.width);
    wire("distortion_model", self.distortion_model);
    wire({"D", "d"}, self.d);
    wire({"K", "k"}, self.k);
    wire({"R", "r"}, self.r);
    wire({"P", "p"}, self.p);
    wire("binning_x", self.binning_x);
    wire("binning_y", self.binning_y);
    wire("roi", self.roi);
  }
};

struct PointMessage {
  static constexpr std::string_view kType = "geometry_msgs/Point";
  double x = 0;
  double y = 0;
  double z = 0;

  static void Fields(auto& self, auto& wire) {
    wire("x", self.x);
    wire("y", self.y);
    wire("z", self.z);
  }
};

struct Vector3Message {
  static constexpr std::string_view kType = "geometry_msgs/Vector3";
  double x = 0;
  double y = 0;
  double z = 0;

  static void Fields(auto& self, auto& wire) { PointMessage::Fields(self, wire); }
};

struct QuaternionMessage {
  static constexpr std::string_view kType = "geometry_msgs/Quaternion";
  double x = 0;
  double y = 0;
  double z = 0;
  double w = 1;

  static void Fields(auto& self, auto& wire) {
    wire("x", self.x);
    wire("y", self.y);
    wire("z", self.z);
    wire("w", self.w);
  }
};

struct PoseMessage {
  static constexpr std::string_view kType = "geometry_msgs/Pose";
  PointMessage position;
  QuaternionMessage orientation;

  static void Fields(auto& self, auto& wire) {
    wire("position", self.position);
    wire("orientation", self.orientation);
  }
};

struct TransformMessage {
  static constexpr std::string_view kType = "geometry_msgs/Transform";
  Vector3Message translation;
  QuaternionMessage rotation;

  static void Fields(auto& self, auto& wire) {
    wire("translation", self.translation);
    wire("rotation", self.rotation);
  }
};

struct TwistMessage {
  static constexpr std::string_view kType = "geometry_msgs/Twist";
  Vector3Message linear;   // m/s
  Vector3Message angular;  // rad/s

  static void Fields(auto& self, auto& wire) {
    wire("linear", self.linear);
    wire("angular", self.angular);
  }
};

struct PoseWithCovarianceMessage {
  static constexpr std::string_view kType = "geometry_msgs/PoseWithCovariance";
  PoseMessage pose;
  std::array<double, 36> covariance{};  // x, y, z, rotations about x, y, z; row by row

  static void Fields(auto& self, auto& wire) {
    wire("pose", self.pose);
    wire("covariance", self.covariance);
  }
};

struct TwistWithCovarianceMessage {
  static constexpr std::string_view kType = "geometry_msgs/TwistWithCovariance";
  TwistMessage twist;
  std::array<double, 36> covariance{};

  static void Fields(auto& self, auto& wire) {
    wire("twist", self.twist);
    wire("covariance", self.covariance);
  }
};

struct PoseStampedMessage {
  static constexpr std::string_view kType = "geometry_msgs/PoseStamped";
  HeaderMessage header;
  PoseMessage pose;

  static void Fields(auto& self, auto& wire) {
    wire("header", self.header);
    wire("pose", self.pose);
  }
};

struct PoseWithCovarianceStampedMessage {
  static constexpr std::string_view kType = "geometry_msgs/PoseWithCovarianceStamped";
  HeaderMessage header;
  PoseWithCovarianceMessage pose;

  static void Fields(auto& self, auto& wire) {
    wire("header", self.header);
    wire("pose", self.pose);
  }
};

struct TransformStampedMessage {
  static constexpr std::string_view kType = "geometry_msgs/TransformStamped";
  HeaderMessage header;
  std::string child_frame_id;
  TransformMessage transform;  // pose of the child in the header's frame

  static void Fields(auto& self, auto& wire) {
    wire("header", self.header);
    wire("child_frame_id", self.child_frame_id);
    wire("transform", self.transform);
  }
};

struct TfMessage {
  static constexpr std::string_view kType = "tf2_msgs/TFMessage";
  std::vector<TransformStampedMessage> transforms;

  static void Fields(auto& self, auto& wire) { wire("transforms", self.transforms); }
};

struct OdometryMessage {
  static constexpr std::string_view kType = "nav_msgs/Odometry";
  HeaderMessage header;
  std::string child_frame_id;
  PoseWithCovarianceMessage pose;
  TwistWithCovarianceMessage twist;  // in the child's frame

  static void Fields(auto& self, auto& wire) {
    wire("header", self.header);
    wire("child_frame_id", self.child_frame_id);
    wire("pose", self.pose);
    wire("twist", self.twist);
  }
};

}  // namespace kestrel
