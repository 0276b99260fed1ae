// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
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

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.header);
    wire.List(self.poses);
  }
};

struct ColorMessage {  // std_msgs/ColorRGBA, 0 to 1
  float r = 0;
  float g = 0;
  float b = 0;
  float a = 1;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.r);
    wire(self.g);
    wire(self.b);
    wire(self.a);
  }
};

struct RosDurationMessage {
  std::int32_t seconds = 0;
  std::int32_t nanoseconds = 0;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.seconds);
    wire(self.nanoseconds);
  }
};

// The texture of a marker; always empty here.
struct EmptyTextureMessage {
  std::string resource;
  CompressedImageMessage texture;
  std::uint32_t coordinate_count = 0;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.resource);
    wire(self.texture);
    wire(self.coordinate_count);
  }
};

struct EmptyMeshMessage {  // visualization_msgs/MeshFile
  std::string file_name;
  std::uint32_t byte_count = 0;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.file_name);
    wire(self.byte_count);
  }
};

// visualization_msgs/Marker.
struct MarkerMessage {
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
  std::uint8_t frame_locked = 0;
  std::vector<Vector3Message> points;  // for an arrow: its ends
  std::vector<ColorMessage> colors;
  EmptyTextureMessage texture;
  std::string text;
  std::string mesh_resource;
  EmptyMeshMessage mesh_file;
  std::uint8_t mesh_use_embedded_materials = 0;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.header);
    wire(self.name_space);
    wire(self.id);
    wire(self.type);
    wire(self.action);
    wire(self.pose);
    wire(self.scale);
    wire(self.color);
    wire(self.lifetime);
    wire(self.frame_locked);
    wire.List(self.points);
    wire.List(self.colors);
    wire(self.texture);
    wire(self.text);
    wire(self.mesh_resource);
    wire(self.mesh_file);
    wire(self.mesh_use_embedded_materials);
  }
};

struct MarkerArrayMessage {
  static constexpr std::string_view kType = "visualization_msgs/MarkerArray";
  std::vector<MarkerMessage> markers;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire.List(self.markers);
  }
};

struct KeyValueMessage {
  std::string key;
  std::string value;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.key);
    wire(self.value);
  }
};

struct DiagnosticStatusMessage {
  enum Level : std::uint8_t { kOk = 0, kWarn = 1, kError = 2, kStale = 3 };

  std::uint8_t level = kOk;
  std::string name;
  std::string message;
  std::string hardware_id;
  std::vector<KeyValueMessage> values;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.level);
    wire(self.name);
    wire(self.message);
    wire(self.hardware_id);
    wire.List(self.values);
  }
};

struct DiagnosticArrayMessage {
  static constexpr std::string_view kType = "diagnostic_msgs/DiagnosticArray";
  HeaderMessage header;
  std::vector<DiagnosticStatusMessage> status;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.header);
    wire.List(self.status);
  }
};

// vision_msgs/ObjectHypothesisWithPose.
struct ObjectHypothesisMessage {
  std::string class_id;  // name of the class
  double score = 0;      // 0 to 1
  PoseMessage pose;
  std::array<double, 36> covariance{};

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.class_id);
    wire(self.score);
    wire(self.pose);
    for (auto& number : self.covariance) wire(number);
  }
};

// vision_msgs/Detection3D.
struct Detection3DMessage {
  HeaderMessage header;
  std::vector<ObjectHypothesisMessage> results;
  PoseMessage box_center;
  Vector3Message box_size;  // m
  std::string id;           // the same from frame to frame

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.header);
    wire.List(self.results);
    wire(self.box_center);
    wire(self.box_size);
    wire(self.id);
  }
};

struct Detection3DArrayMessage {
  static constexpr std::string_view kType = "vision_msgs/Detection3DArray";
  HeaderMessage header;
  std::vector<Detection3DMessage> detections;

  template <class Self, class Wire>
  static void Fields(Self& self, Wire& wire) {
    wire(self.header);
    wire.List(self.detections);
  }
};

}  // namespace kestrel
