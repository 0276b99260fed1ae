// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/io/ros_messages/messages.h"

namespace kestrel {

// The messages of ROS 2 (since Humble) that only results need, by the same rules as in messages.h.

struct PathMessage {
  static constexpr std::string_view kType = "nav_msgs/Path";
  HeaderMessage header;
  std::vector<PoseStampedMessage> poses;

  static void Fields(auto& self, auto& wire) {
    wire("header", self.header);
    wire("poses", self.poses);
  }
};

struct ColorMessage {  // 0 to 1
  static constexpr std::string_view kType = "std_msgs/ColorRGBA";
  float r = 0;
  float g = 0;
  float b = 0;
  float a = 1;

  static void Fields(auto& self, auto& wire) {
    wire("r", self.r);
    wire("g", self.g);
    wire("b", self.b);
    wire("a", self.a);
  }
};

struct RosDurationMessage {
  static constexpr std::string_view kType = "builtin_interfaces/Duration";
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;

  static void Fields(auto& self, auto& wire) { TimeMessage::Fields(self, wire); }
};

struct UvCoordinateMessage {
  static constexpr std::string_view kType = "visualization_msgs/UVCoordinate";
  float u = 0;
  float v = 0;

  static void Fields(auto& self, auto& wire) {
    wire("u", self.u);
    wire("v", self.v);
  }
};

struct MeshFileMessage {
  static constexpr std::string_view kType = "visualization_msgs/MeshFile";
  std::string filename;
  std::string_view data;

  static void Fields(auto& self, auto& wire) {
    wire("filename", self.filename);
    wire("data", self.data);
  }
};

struct MarkerMessage {
  static constexpr std::string_view kType = "visualization_msgs/Marker";
  static constexpr std::string_view kConstants =
      "int32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\n"
      "int32 LINE_LIST=5\nint32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\n"
      "int32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\nint32 TRIANGLE_LIST=11\n"
      "int32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\n";
  enum Shape : std::int32_t { kArrow = 0, kCube = 1, kSphere = 2, kCylinder = 3, kText = 9 };
  enum Action : std::int32_t { kAdd = 0, kDelete = 2, kDeleteAll = 3 };

  HeaderMessage header;
  std::string name_space;
  std::int32_t id = 0;
  std::int32_t type = kArrow;
  std::int32_t action = kAdd;
  PoseMessage pose;
  Vector3Message scale;  // m
  ColorMessage color;
  RosDurationMessage lifetime;  // 0: for ever
  bool frame_locked = false;
  std::vector<PointMessage> points;  // for an arrow: its ends
  std::vector<ColorMessage> colors;
  std::string texture_resource;
  CompressedImageMessage texture;
  std::vector<UvCoordinateMessage> uv_coordinates;
  std::string text;
  std::string mesh_resource;
  MeshFileMessage mesh_file;
  bool mesh_use_embedded_materials = false;

  static void Fields(auto& self, auto& wire) {
    wire("header", self.header);
    wire("ns", self.name_space);
    wire("id", self.id);
    wire("type", self.type);
    wire("action", self.action);
    wire("pose", self.pose);
    wire("scale", self.scale);
    wire("color", self.color);
    wire("lifetime", self.lifetime);
    wire("frame_locked", self.frame_locked);
    wire("points", self.points);
    wire("colors", self.colors);
    wire("texture_resource", self.texture_resource);
    wire("texture", self.texture);
    wire("uv_coordinates", self.uv_coordinates);
    wire("text", self.text);
    wire("mesh_resource", self.mesh_resource);
    wire("mesh_file", self.mesh_file);
    wire("mesh_use_embedded_materials", self.mesh_use_embedded_materials);
  }
};

struct MarkerArrayMessage {
  static constexpr std::string_view kType = "visualization_msgs/MarkerArray";
  std::vector<MarkerMessage> markers;

  static void Fields(auto& self, auto& wire) { wire("markers", self.markers); }
};

struct KeyValueMessage {
  static constexpr std::string_view kType = "diagnostic_msgs/KeyValue";
  std::string key;
  std::string value;

  static void Fields(auto& self, auto& wire) {
    wire("key", self.key);
    wire("value", self.value);
  }
};

struct DiagnosticStatusMessage {
  static constexpr std::string_view kType = "diagnostic_msgs/DiagnosticStatus";
  static constexpr std::string_view kConstants =
      "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\n";
  enum Level : std::uint8_t { kOk = 0, kWarn = 1, kError = 2, kStale = 3 };

  Level level = kOk;
  std::string name;
  std::string message;
  std::string hardware_id;
  std::vector<KeyValueMessage> values;

  static void Fields(auto& self, auto& wire) {
    wire("level", self.level);
    wire("name", self.name);
    wire("message", self.message);
    wire("hardware_id", self.hardware_id);
    wire("values", self.values);
  }
};

struct DiagnosticArrayMessage {
  static constexpr std::string_view kType = "diagnostic_msgs/DiagnosticArray";
  HeaderMessage header;
  std::vector<DiagnosticStatusMessage> status;

  static void Fields(auto& self, auto& wire) {
    wire("header", self.header);
    wire("status", self.status);
  }
};

struct ObjectHypothesisMessage {
  static constexpr std::string_view kType = "vision_msgs/ObjectHypothesis";
  std::string class_id;  // name of the class
  double score = 0;      // 0 to 1

  static void Fields(auto& self, auto& wire) {
    wire("class_id", self.class_id);
    wire("score", self.score);
  }
};

struct ObjectHypothesisWithPoseMessage {
  static constexpr std::string_view kType = "vision_msgs/ObjectHypothesisWithPose";
  ObjectHypothesisMessage hypothesis;
  PoseWithCovarianceMessage pose;

  static void Fields(auto& self, auto& wire) {
    wire("hypothesis", self.hypothesis);
    wire("pose", self.pose);
  }
};

struct BoundingBox3DMessage {
  static constexpr std::string_view kType = "vision_msgs/BoundingBox3D";
  PoseMessage center;
  Vector3Message size;  // m

  static void Fields(auto& self, auto& wire) {
    wire("center", self.center);
    wire("size", self.size);
  }
};

struct Detection3DMessage {
  static constexpr std::string_view kType = "vision_msgs/Detection3D";
  HeaderMessage header;
  std::vector<ObjectHypothesisWithPoseMessage> results;
  BoundingBox3DMessage box;
  std::string id;  // the same from frame to frame

  static void Fields(auto& self, auto& wire) {
    wire("header", self.header);
    wire("results", self.results);
    wire("bbox", self.box);
    wire("id", self.id);
  }
};

struct Detection3DArrayMessage {
  static constexpr std::string_view kType = "vision_msgs/Detection3DArray";
  HeaderMessage header;
  std::vector<Detection3DMessage> detections;

  static void Fields(auto& self, auto& wire) {
    wire("header", self.header);
    wire("detections", self.detections);
  }
};

}  // namespace kestrel
