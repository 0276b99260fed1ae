// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/middleware/hunt_messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/bags/frame_tree.h"
#include "kestrel/middleware/message_covariance.h"
#include "kestrel/team/team_view.h"

namespace kestrel {
namespace {

constexpr double kFlat_m = 0.01;

PoseMessage PoseAt(const Eigen::Vector3d& position) { return PoseMessageOf({{}, position}); }

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

// Puts an object of the class into the array.
Detection3DMessage& AddDetection(const ObjectModel& model, std::size_t class_index, double score,
                                 const ObjectLocation& location, Detection3DArrayMessage* message) {
  const ObjectClass& found_class = model.classes[class_index];
  Detection3DMessage& found = message->detections.emplace_back();
  found.header = message->header;
  found.source_cloud.header = message->header;
  found.box_center = PoseAt(location.position);
  found.box_size = SizeOf(found_class);
  ObjectHypothesisMessage& result = found.results.emplace_back();
  result.id = static_cast<std::int64_t>(class_index);
  result.class_id = found_class.name;
  result.score = score;
  result.pose = found.box_center;
  result.covariance = CovarianceOf(location.covariance);
  return found;
}

MarkerArrayMessage NoMarkers(Time stamp, const std::string& frame) {
  MarkerArrayMessage message;
  MarkerMessage& none = message.markers.emplace_back();
  none.header = {0, stamp, frame};
  none.action = MarkerMessage::kDeleteAll;
  return message;
}

// By the hue alone: as paint, not as it looked in that light.
ColorMessage PaintOf(const Hsv& color) {
  const auto channel = [&](float shift) {
    const float part = std::fmod(shift + color.hue_deg / 60, 6.0F);
    return 1 - std::clamp(std::min(part, 4 - part), 0.0F, 1.0F);
  };
  return {channel(5), channel(3), channel(1), 0.9F};
}

}  // namespace

Detection3DArrayMessage DetectionsOf(const HuntObservation& observation, const ObjectModel& model,
                                     const std::string& camera_frame) {
  Detection3DArrayMessage message;
  message.header = {0, observation.time, camera_frame};
  for (const ObjectDetection& detection : observation.report.detections) {
    if (!detection.location) continue;
    AddDetection(model, detection.class_index, detection.class_probability, *detection.location,
                 &message);
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
    const auto class_index = ClassOf(object, model);
    if (!class_index) continue;
    const double score = 1 / (1 + std::exp(-object.log_odds));
    const ObjectLocation location{object.position(), object.covariance.topLeftCorner<3, 3>()};
    AddDetection(model, *class_index, score, location, &message).id = std::to_string(object.id);
  }
  return message;
}

MarkerArrayMessage TeamMarkersOf(const TeamReport& team, const ObjectModel& model,
                                 const std::string& world_frame) {
  constexpr double kText_m = 0.3;
  MarkerArrayMessage message = NoMarkers(team.time, world_frame);
  for (const TeamObject& known : team.objects) {
    const auto class_index = ClassOf(known.object, model);
    if (!class_index) continue;
    const ObjectClass& of = model.classes[*class_index];
    MarkerMessage marker;
    marker.header = message.markers.front().header;
    marker.name_space = "team";
    marker.id = static_cast<std::int32_t>(known.object.id);
    marker.type = MarkerMessage::kCube;
    marker.pose = PoseAt(known.object.position());
    marker.scale = SizeOf(of);
    marker.color = PaintOf(known.object.color);
    message.markers.push_back(marker);
    marker.name_space = "team_names";
    marker.type = MarkerMessage::kText;
    marker.pose.position.z += kText_m;
    marker.scale = {0, 0, kText_m};
    marker.color = {1, 1, 1, 1};
    marker.text = fmt::format("{}: {}", of.name, fmt::join(known.uavs, " "));
    if (!known.holder.empty()) marker.text += ", for " + known.holder;
    message.markers.push_back(std::move(marker));
  }
  return message;
}

}  // namespace kestrel
