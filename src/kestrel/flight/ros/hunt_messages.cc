// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/hunt_messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/comms/team/team_view.h"
#include "kestrel/flight/ros/message_covariance.h"
#include "kestrel/vision/mapping/mapped_object.h"

namespace kestrel {
namespace {

constexpr double kFlat_m = 0.01;
constexpr double kLabelHeight_m = 0.25;

PoseMessage PoseAt(const Eigen::Vector3d& position) {
  return {{position.x(), position.y(), position.z()}, {}};
}

std::array<double, 36> CovarianceOf(const Eigen::Matrix3d& position) {
  MessageCovariance covariance = MessageCovariance::Zero();
  covariance.topLeftCorner<3, 3>() = position;
  covariance.diagonal().tail<3>().setConstant(kUnknownAngleVariance);
  return NumbersOf(covariance);
}

Vector3Message SizeOf(const ObjectClass& of) {
  const double width = of.width_m > 0 ? of.width_m : of.size_m;
  return {of.size_m, width, std::max(of.height_m, kFlat_m)};
}

// Returns the colour by its hue alone: as paint, without the light in which it was seen.
ColorMessage PaintOf(const Hsv& color) {
  const auto channel = [&](float shift) {
    const float part = std::fmod(shift + color.hue_deg / 60, 6.0F);
    return 1 - std::clamp(std::min(part, 4 - part), 0.0F, 1.0F);
  };
  return {channel(5), channel(3), channel(1), 0.9F};
}

// An object of the map, whose origin is the middle of its upper face.
struct Body {
  std::optional<std::size_t> class_index;
  Vector3Message size;
  PoseMessage center;
};

Body BodyOf(const MappedObject& object, const ObjectModel& model) {
  Body body;
  body.class_index = ClassOf(object, model);
  body.size = SizeOf(body.class_index ? model.classes[*body.class_index] : ObjectClass());
  body.center = PoseAt(object.position() - 0.5 * body.size.z * Eigen::Vector3d::UnitZ());
  return body;
}

std::string LabelOf(const MappedObject& object, const Body& body, const ObjectModel& model) {
  const std::string name =
      body.class_index ? model.classes[*body.class_index].name : ToString(object.shape);
  const auto digit = object.digit();
  return digit ? fmt::format("{} {}", name, digit->digit) : name;
}

MarkerMessage MapMarker(const MappedObject& object, const HeaderMessage& header,
                        const char* name_space, MarkerMessage::Shape shape) {
  MarkerMessage marker;
  marker.header = header;
  marker.name_space = name_space;
  marker.id = static_cast<std::int32_t>(object.id);
  marker.type = shape;
  marker.color = PaintOf(object.color);
  return marker;
}

MarkerMessage BodyMarker(const MappedObject& object, const Body& body,
                         const HeaderMessage& header) {
  MarkerMessage marker = MapMarker(
      object, header, "map",
      object.shape == ObjectShape::kDisc ? MarkerMessage::kCylinder : MarkerMessage::kCube);
  marker.pose = body.center;
  marker.scale = body.size;
  return marker;
}

MarkerMessage LabelMarker(const MappedObject& object, const std::string& label,
                          const HeaderMessage& header) {
  MarkerMessage marker = MapMarker(object, header, "labels", MarkerMessage::kText);
  marker.pose = PoseAt(object.position() + kLabelHeight_m * Eigen::Vector3d::UnitZ());
  marker.scale.z = kLabelHeight_m;
  marker.color = {1, 1, 1, 1};
  marker.text = label;
  return marker;
}

// Returns an array whose first marker deletes all earlier markers of the topic.
MarkerArrayMessage NoMarkers(Time stamp, const std::string& frame) {
  MarkerArrayMessage message;
  MarkerMessage& none = message.markers.emplace_back();
  none.header = {0, stamp, frame};
  none.action = MarkerMessage::kDeleteAll;
  return message;
}

// Returns a label like "red: one two, for two".
std::string TeamLabelOf(const TeamObject& known, const std::string& what) {
  const std::string label = fmt::format("{}: {}", what, fmt::join(known.uavs, " "));
  return known.holder.empty() ? label : label + ", for " + known.holder;
}

}  // namespace

Detection3DArrayMessage DetectionsOf(const HuntObservation& observation, const ObjectModel& model,
                                     const std::string& camera_frame) {
  Detection3DArrayMessage message;
  message.header = {0, observation.time, camera_frame};
  for (const ObjectDetection& detection : observation.report.detections) {
    if (!detection.location) continue;
    const ObjectClass& found_class = model.classes[detection.class_index];
    Detection3DMessage& found = message.detections.emplace_back();
    found.header = message.header;
    found.box = {PoseAt(detection.location->position), SizeOf(found_class)};
    found.results.push_back({{found_class.name, detection.class_probability},
                             {found.box.center, CovarianceOf(detection.location->covariance)}});
  }
  return message;
}

MarkerArrayMessage MarkersOf(const HuntObservation& observation, const ObjectModel& model,
                             const std::string& world_frame) {
  MarkerArrayMessage message = NoMarkers(observation.time, world_frame);
  for (std::size_t i = 0; i < observation.in_world.size(); ++i) {
    const std::optional<ObjectLocation>& location = observation.in_world[i];
    if (!location) continue;
    const ObjectDetection& detection = observation.report.detections[i];
    MarkerMessage& marker = message.markers.emplace_back();
    marker.header = message.markers.front().header;
    marker.name_space = "objects";
    marker.id = static_cast<std::int32_t>(i);
    marker.type = MarkerMessage::kCylinder;
    marker.pose = PoseAt(location->position);
    marker.scale = SizeOf(model.classes[detection.class_index]);
    marker.color = PaintOf(detection.mean_color);
    marker.lifetime = {1, 0};
  }
  return message;
}

Detection3DArrayMessage TeamDetectionsOf(const TeamReport& team, const ObjectModel& model,
                                         const std::string& world_frame) {
  Detection3DArrayMessage message;
  message.header = {0, team.time, world_frame};
  for (const TeamObject& known : team.objects) {
    const MappedObject& object = known.object;
    const Body body = BodyOf(object, model);
    Detection3DMessage& mapped = message.detections.emplace_back();
    mapped.header = message.header;
    mapped.box = {body.center, body.size};
    mapped.id = fmt::to_string(object.id);
    if (!body.class_index) continue;
    mapped.results.push_back(
        {{model.classes[*body.class_index].name, 1 / (1 + std::exp(-object.log_odds))},
         {PoseAt(object.position()), CovarianceOf(object.covariance.topLeftCorner<3, 3>())}});
  }
  return message;
}

MarkerArrayMessage TeamMarkersOf(const TeamReport& team, const ObjectModel& model,
                                 const std::string& world_frame) {
  MarkerArrayMessage message = NoMarkers(team.time, world_frame);
  const HeaderMessage header = message.markers.front().header;
  for (const TeamObject& known : team.objects) {
    const Body body = BodyOf(known.object, model);
    const std::string label = TeamLabelOf(known, LabelOf(known.object, body, model));
    message.markers.push_back(BodyMarker(known.object, body, header));
    message.markers.push_back(LabelMarker(known.object, label, header));
  }
  return message;
}

}  // namespace kestrel
