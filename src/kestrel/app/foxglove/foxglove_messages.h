// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/app/foxglove/protobuf_schema.h"
#include "kestrel/app/foxglove/protobuf_writer.h"
#include "kestrel/core/base/time.h"

// The standard messages of Foxglove and other viewers (docs.foxglove.dev/docs/sdk/schemas), with
// the fields that Kestrel fills; and some of Kestrel's own.
namespace kestrel::foxglove {

struct Point2 {  // px, 0 is the corner of the first pixel
  static constexpr std::string_view kType = "foxglove.Point2";
  double x = 0;
  double y = 0;

  static void Fields(auto& self, auto& visit) {
    visit(1, "x", self.x);
    visit(2, "y", self.y);
  }
};

struct Point3 {  // m
  static constexpr std::string_view kType = "foxglove.Point3";
  double x = 0;
  double y = 0;
  double z = 0;

  static void Fields(auto& self, auto& visit) {
    visit(1, "x", self.x);
    visit(2, "y", self.y);
    visit(3, "z", self.z);
  }
};

struct Vector3 {
  static constexpr std::string_view kType = "foxglove.Vector3";
  double x = 0;
  double y = 0;
  double z = 0;

  static void Fields(auto& self, auto& visit) { Point3::Fields(self, visit); }
};

struct Quaternion {
  static constexpr std::string_view kType = "foxglove.Quaternion";
  double x = 0;
  double y = 0;
  double z = 0;
  double w = 1;

  static void Fields(auto& self, auto& visit) {
    Point3::Fields(self, visit);
    visit(4, "w", self.w);
  }
};

struct Pose {
  static constexpr std::string_view kType = "foxglove.Pose";
  Vector3 position;
  Quaternion orientation;

  static void Fields(auto& self, auto& visit) {
    visit(1, "position", self.position);
    visit(2, "orientation", self.orientation);
  }
};

struct Color {  // 0 to 1
  static constexpr std::string_view kType = "foxglove.Color";
  double r = 0;
  double g = 0;
  double b = 0;
  double a = 1;

  static void Fields(auto& self, auto& visit) {
    visit(1, "r", self.r);
    visit(2, "g", self.g);
    visit(3, "b", self.b);
    visit(4, "a", self.a);
  }
};

struct CompressedImage {
  static constexpr std::string_view kType = "foxglove.CompressedImage";
  Time timestamp;
  std::string frame_id;
  ProtobufBytes data;
  std::string format;  // "jpeg"

  static void Fields(auto& self, auto& visit) {
    visit(1, "timestamp", self.timestamp);
    visit(2, "data", self.data);
    visit(3, "format", self.format);
    visit(4, "frame_id", self.frame_id);
  }
};

struct CameraCalibration {
  static constexpr std::string_view kType = "foxglove.CameraCalibration";
  Time timestamp;
  std::string frame_id;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::string distortion_model;
  std::vector<double> d;
  std::array<double, 9> k{};  // row by row, as the next two
  std::array<double, 9> r{};
  std::array<double, 12> p{};

  static void Fields(auto& self, auto& visit) {
    visit(1, "timestamp", self.timestamp);
    visit(2, "width", self.width);
    visit(3, "height", self.height);
    visit(4, "distortion_model", self.distortion_model);
    visit(5, "D", self.d);
    visit(6, "K", self.k);
    visit(7, "R", self.r);
    visit(8, "P", self.p);
    visit(9, "frame_id", self.frame_id);
  }
};

enum class PointsType { kUnknown, kPoints, kLineLoop, kLineStrip, kLineList };

struct PointsAnnotation {
  static constexpr std::string_view kType = "foxglove.PointsAnnotation";
  Time timestamp;
  PointsType type = PointsType::kUnknown;
  std::vector<Point2> points;
  Color outline_color;
  Color fill_color;
  double thickness = 0;  // px

  static void Fields(auto& self, auto& visit) {
    visit(1, "timestamp", self.timestamp);
    visit(2, "type", self.type);
    visit(3, "points", self.points);
    visit(4, "outline_color", self.outline_color);
    visit(6, "fill_color", self.fill_color);
    visit(7, "thickness", self.thickness);
  }
};

struct TextAnnotation {
  static constexpr std::string_view kType = "foxglove.TextAnnotation";
  Time timestamp;
  Point2 position;  // where its lower left corner is
  std::string text;
  double font_size = 0;  // px
  Color text_color;
  Color background_color;

  static void Fields(auto& self, auto& visit) {
    visit(1, "timestamp", self.timestamp);
    visit(2, "position", self.position);
    visit(3, "text", self.text);
    visit(4, "font_size", self.font_size);
    visit(5, "text_color", self.text_color);
    visit(6, "background_color", self.background_color);
  }
};

struct ImageAnnotations {
  static constexpr std::string_view kType = "foxglove.ImageAnnotations";
  std::vector<PointsAnnotation> points;
  std::vector<TextAnnotation> texts;

  static void Fields(auto& self, auto& visit) {
    visit(2, "points", self.points);
    visit(3, "texts", self.texts);
  }
};

struct FrameTransform {
  static constexpr std::string_view kType = "foxglove.FrameTransform";
  Time timestamp;
  std::string parent_frame_id;
  std::string child_frame_id;
  Vector3 translation;
  Quaternion rotation;

  static void Fields(auto& self, auto& visit) {
    visit(1, "timestamp", self.timestamp);
    visit(2, "parent_frame_id", self.parent_frame_id);
    visit(3, "child_frame_id", self.child_frame_id);
    visit(4, "translation", self.translation);
    visit(5, "rotation", self.rotation);
  }
};

struct FrameTransforms {
  static constexpr std::string_view kType = "foxglove.FrameTransforms";
  std::vector<FrameTransform> transforms;

  static void Fields(auto& self, auto& visit) { visit(1, "transforms", self.transforms); }
};

struct PoseInFrame {
  static constexpr std::string_view kType = "foxglove.PoseInFrame";
  Time timestamp;
  std::string frame_id;
  Pose pose;

  static void Fields(auto& self, auto& visit) {
    visit(1, "timestamp", self.timestamp);
    visit(2, "frame_id", self.frame_id);
    visit(3, "pose", self.pose);
  }
};

struct SpherePrimitive {
  static constexpr std::string_view kType = "foxglove.SpherePrimitive";
  Pose pose;
  Vector3 size;  // diameters along its axes, m
  Color color;

  static void Fields(auto& self, auto& visit) {
    visit(1, "pose", self.pose);
    visit(2, "size", self.size);
    visit(3, "color", self.color);
  }
};

enum class LineType { kLineStrip, kLineLoop, kLineList };

struct LinePrimitive {
  static constexpr std::string_view kType = "foxglove.LinePrimitive";
  LineType type = LineType::kLineStrip;
  Pose pose;
  double thickness = 0;  // m, or px where it is scale-invariant
  bool scale_invariant = false;
  std::vector<Point3> points;
  Color color;

  static void Fields(auto& self, auto& visit) {
    visit(1, "type", self.type);
    visit(2, "pose", self.pose);
    visit(3, "thickness", self.thickness);
    visit(4, "scale_invariant", self.scale_invariant);
    visit(5, "points", self.points);
    visit(6, "color", self.color);
  }
};

struct TextPrimitive {
  static constexpr std::string_view kType = "foxglove.TextPrimitive";
  Pose pose;
  bool billboard = false;  // faces the viewer
  double font_size = 0;    // m, or px where it is scale-invariant
  bool scale_invariant = false;
  Color color;
  std::string text;

  static void Fields(auto& self, auto& visit) {
    visit(1, "pose", self.pose);
    visit(2, "billboard", self.billboard);
    visit(3, "font_size", self.font_size);
    visit(4, "scale_invariant", self.scale_invariant);
    visit(5, "color", self.color);
    visit(6, "text", self.text);
  }
};

// An object in the world. It replaces one with the same id; else it disappears after its lifetime.
struct SceneEntity {
  static constexpr std::string_view kType = "foxglove.SceneEntity";
  Time timestamp;
  std::string frame_id;
  std::string id;
  Duration lifetime{};
  std::vector<SpherePrimitive> spheres;
  std::vector<LinePrimitive> lines;
  std::vector<TextPrimitive> texts;

  static void Fields(auto& self, auto& visit) {
    visit(1, "timestamp", self.timestamp);
    visit(2, "frame_id", self.frame_id);
    visit(3, "id", self.id);
    visit(4, "lifetime", self.lifetime);
    visit(9, "spheres", self.spheres);
    visit(11, "lines", self.lines);
    visit(13, "texts", self.texts);
  }
};

struct SceneUpdate {
  static constexpr std::string_view kType = "foxglove.SceneUpdate";
  std::vector<SceneEntity> entities;

  static void Fields(auto& self, auto& visit) { visit(2, "entities", self.entities); }
};

enum class LogLevel { kUnknown, kDebug, kInfo, kWarning, kError, kFatal };

struct Log {
  static constexpr std::string_view kType = "foxglove.Log";
  Time timestamp;
  LogLevel level = LogLevel::kUnknown;
  std::string message;
  std::string name;  // name of the sender

  static void Fields(auto& self, auto& visit) {
    visit(1, "timestamp", self.timestamp);
    visit(2, "level", self.level);
    visit(3, "message", self.message);
    visit(4, "name", self.name);
  }
};

// A detection in a frame.
struct Detection {
  static constexpr std::string_view kType = "kestrel.Detection";
  std::string name;        // how the pattern's cross was verified, or the class of an object
  double probability = 0;  // probability that it is right
  Point2 center;           // px; as for all pixels here, 0 is the corner of the first
  // In m, and m^2 row by row; empty where unknown.
  std::optional<Vector3> position_in_camera;
  std::vector<double> covariance_in_camera;
  std::optional<Vector3> position_in_world;
  std::vector<double> covariance_in_world;

  static void Fields(auto& self, auto& visit) {
    visit(1, "name", self.name);
    visit(2, "probability", self.probability);
    visit(3, "center", self.center);
    visit(4, "position_in_camera", self.position_in_camera);
    visit(5, "covariance_in_camera", self.covariance_in_camera);
    visit(6, "position_in_world", self.position_in_world);
    visit(7, "covariance_in_world", self.covariance_in_world);
  }
};

// The landing target by its track, in the world's frame.
struct Target {
  static constexpr std::string_view kType = "kestrel.Target";
  Vector3 position;                // m
  Vector3 velocity;                // m/s
  double heading = 0;              // rad, from x (east) towards y (north)
  double turn_rate = 0;            // rad/s
  std::vector<double> covariance;  // position and velocity: 6 x 6, row by row

  static void Fields(auto& self, auto& visit) {
    visit(1, "position", self.position);
    visit(2, "velocity", self.velocity);
    visit(3, "heading", self.heading);
    visit(4, "turn_rate", self.turn_rate);
    visit(5, "covariance", self.covariance);
  }
};

// The result of a frame, with its durations.
struct FrameResult {
  static constexpr std::string_view kType = "kestrel.FrameResult";
  Time timestamp;                                                // when the frame was taken
  std::string frame;                                             // its name; empty in flight
  double detect_ms = 0;                                          // the detection alone
  double latency_ms = std::numeric_limits<double>::quiet_NaN();  // from capture to this, in flight
  std::string state;   // state of the track, as "tracking"; for a hunt, as "3 in view"
  std::string reason;  // why the state is no better
  std::vector<Detection> detections;
  std::optional<Target> target;

  static void Fields(auto& self, auto& visit) {
    visit(1, "timestamp", self.timestamp);
    visit(2, "frame", self.frame);
    visit(3, "detect_ms", self.detect_ms);
    visit(4, "latency_ms", self.latency_ms);
    visit(5, "state", self.state);
    visit(6, "reason", self.reason);
    visit(7, "detections", self.detections);
    visit(8, "target", self.target);
  }
};

}  // namespace kestrel::foxglove

namespace kestrel {

template <>
struct ProtobufEnum<foxglove::PointsType> {
  static constexpr const char* kName = "Type";
  static constexpr std::array kValues{"UNKNOWN", "POINTS", "LINE_LOOP", "LINE_STRIP", "LINE_LIST"};
};
template <>
struct ProtobufEnum<foxglove::LineType> {
  static constexpr const char* kName = "Type";
  static constexpr std::array kValues{"LINE_STRIP", "LINE_LOOP", "LINE_LIST"};
};
template <>
struct ProtobufEnum<foxglove::LogLevel> {
  static constexpr const char* kName = "Level";
  static constexpr std::array kValues{"UNKNOWN", "DEBUG", "INFO", "WARNING", "ERROR", "FATAL"};
};

}  // namespace kestrel
