// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/middleware/hunt_messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "kestrel/bags/frame_tree.h"
#include "kestrel/middleware/message_covariance.h"

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
    const ObjectClass& found_class = model.classes[detection.class_index];
    Detection3DMessage& found = message.detections.emplace_back();
    found.header = message.header;
    found.source_cloud.header = message.header;
    found.box_center = PoseAt(detection.location->position);
    found.box_size = SizeOf(found_class);
    ObjectHypothesisMessage& result = found.results.emplace_back();
    result.id = static_cast<std::int64_t>(detection.class_index);
    result.class_id = found_class.name;
    result.score = detection.class_probability;
    result.pose = found.box_center;
    result.covariance = CovarianceOf(detection.location->covariance);
  }
  return message;
}

MarkerArrayMessage MarkersOf(const HuntObservation& observation, const ObjectModel& model,
                             const std::string& world_frame) {
  MarkerArrayMessage message;
  MarkerMessage& none = message.markers.emplace_back();
  none.header = {0, observation.time, world_frame};
  none.action = MarkerMessage::kDeleteAll;
  for (std::size_t i = 0; i < observation.in_world.size(); ++i) {
    const std::optional<ObjectLocation>& location = observation.in_world[i];
    if (!location) continue;
    const ObjectDetection& detection = observation.report.detections[i];
    MarkerMessage& marker = message.markers.emplace_back();
    marker.header = none.header;
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

}  // namespace kestrel
