// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/views/hunt_view.h"

#include <cmath>
#include <memory>
#include <numbers>

#include <fmt/format.h>

#include "kestrel/app/views/map_view.h"
#include "kestrel/app/views/segmentation_view.h"

namespace kestrel {
namespace {

std::vector<cv::Point2f> Outline(const Ellipse& ellipse) {
  constexpr int kPieces = 32;
  std::vector<cv::Point2f> outline;
  for (int i = 0; i < kPieces; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPieces;
    const Eigen::Vector2d point = ellipse.center +
                                  ellipse.semi_major * std::cos(angle) * ellipse.major_axis() +
                                  ellipse.semi_minor * std::sin(angle) * ellipse.minor_axis();
    outline.emplace_back(static_cast<float>(point.x()), static_cast<float>(point.y()));
  }
  return outline;
}

// For example "red 0.98".
std::string Label(const HuntView& view, const ObjectDetection& found) {
  return fmt::format("{} {:.2f}", view.model.classes[found.class_index].name,
                     found.class_probability);
}

OverlayShape Shape(const HuntView& view, const ObjectDetection& found, OverlayLayer layer) {
  return {layer, Outline(found.ellipse), Label(view, found)};
}

// Numbers of segments that each test rejected, as "rejected: 9 by size, 1 by shape"; empty: none.
std::string Rejections(const ObjectReport& report) {
  std::string text;
  for (std::size_t stage = 1; stage < kObjectStageCount; ++stage) {
    const int fallen = report.passed[stage - 1] - report.passed[stage];
    if (fallen <= 0) continue;
    text += fmt::format("{} {} by {}", text.empty() ? "rejected:" : ",", fallen,
                        ToString(static_cast<ObjectStage>(stage)));
  }
  return text;
}

}  // namespace

std::vector<SeriesDescription> HuntSeries() {
  using enum ValueSource;
  return {{"objects", "", "Objects in view", {kFrames}, true},
          {"detect", "ms", "Detection", {kFrames}}};
}

ViewSample HuntSample(const HuntObservation& observation) {
  return {observation.time,
          {static_cast<double>(observation.report.detections.size()),
           1e3 * ToSeconds(observation.detect_time)}};
}

std::vector<OverlayLayer> HuntLayers() {
  return {OverlayLayer::kDetection, OverlayLayer::kRejected};
}

std::vector<OverlayShape> HuntShapes(const HuntView& view, const HuntObservation& observation) {
  std::vector<OverlayShape> shapes;
  for (const ObjectDetection& found : observation.report.detections) {
    shapes.push_back(Shape(view, found, OverlayLayer::kDetection));
  }
  for (const ObjectDetection& elsewhere : observation.report.elsewhere) {
    OverlayShape& shape = shapes.emplace_back(Shape(view, elsewhere, OverlayLayer::kRejected));
    shape.label += ", by its size not on the ground";
  }
  return shapes;
}

std::vector<ImageView> HuntImageViews(const HuntView& view) {
  const auto segmentation = std::make_shared<SegmentationView>(view.model, view.detector);
  return {
      {"segmentation", [segmentation](const cv::Mat& image) { return segmentation->Draw(image); }}};
}

ViewStatus HuntStatus(const HuntObservation& observation) {
  const std::size_t objects = observation.report.detections.size();
  ViewStatus status;
  status.state = objects == 0 ? "nothing in view" : fmt::format("{} in view", objects);
  if (objects == 0) status.reason = Rejections(observation.report);
  if (!observation.world_from_camera) status.reason = "where the UAV was is not known";
  return status;
}

std::vector<ViewFact> HuntFacts(const HuntView& view, const HuntObservation& observation) {
  std::vector<std::string> labels;
  for (const ObjectDetection& found : observation.report.detections) {
    labels.push_back(Label(view, found));
  }
  return {{"objects", std::to_string(labels.size())},
          {"classes", fmt::format("{}", fmt::join(labels, ", "))}};
}

ViewMap HuntMap(const HuntView& view, const HuntObservation& observation) {
  ViewMap map;
  PlaceUav(observation.world_from_camera, &map);
  for (std::size_t i = 0; i < observation.in_world.size(); ++i) {
    const auto& location = observation.in_world[i];
    if (!location) continue;
    const std::size_t class_index = observation.report.detections[i].class_index;
    map.objects.push_back({.label = view.model.classes[class_index].name,
                           .color = "",
                           .position = location->position.head<2>(),
                           .covariance = location->covariance.topLeftCorner<2, 2>()});
  }
  return map;
}

ViewedTeam HuntTeam(const HuntView& view, const TeamReport& report) {
  ViewedTeam team;
  for (const auto& [object, uavs, holder] : report.objects) {
    const auto class_index = ClassOf(object, view.model);
    team.objects.push_back({.object = {.label = class_index ? view.model.classes[*class_index].name
                                                            : ToString(object.shape),
                                       .color = "",
                                       .position = object.position().head<2>(),
                                       .covariance = object.covariance.topLeftCorner<2, 2>()},
                            .uavs = uavs,
                            .holder = holder});
  }
  return team;
}

}  // namespace kestrel
