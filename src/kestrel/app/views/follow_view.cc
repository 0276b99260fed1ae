// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/views/follow_view.h"

#include <limits>
#include <tuple>

#include <fmt/format.h>

#include "kestrel/app/views/map_view.h"

namespace kestrel {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

std::vector<cv::Point2f> OutlineOf(const cv::Rect2d& box) {
  const cv::Point2f corner(box.tl());
  const auto width = static_cast<float>(box.width), height = static_cast<float>(box.height);
  return {corner, corner + cv::Point2f(width, 0), corner + cv::Point2f(width, height),
          corner + cv::Point2f(0, height)};
}

}  // namespace

std::vector<SeriesDescription> FollowSeries() {
  using enum ValueSource;
  return {{"probability", "", "Probability", {kFrames}},
          {"distance", "m", "Distance", {kFrames, kPose}},
          {"speed", "m/s", "Speed", {kFrames, kPose}},
          {"detect", "ms", "Tracker", {kFrames}}};
}

ViewSample FollowSample(const FollowObservation& observation) {
  const auto& [region, target] = std::tie(observation.region, observation.target);
  return {observation.time,
          {region ? region->probability : kNotKnown, observation.distance_m().value_or(kNotKnown),
           target ? target->speed() : kNotKnown, 1e3 * ToSeconds(observation.detect_time)}};
}

std::vector<OverlayLayer> FollowLayers() {
  return {OverlayLayer::kDetection, OverlayLayer::kPrediction};
}

std::vector<OverlayShape> FollowShapes(const FollowObservation& observation) {
  const auto& region = observation.region;
  if (!region || region->state == RegionState::kLost) return {};
  const bool is_seen = region->state == RegionState::kFollowing;
  return {{is_seen ? OverlayLayer::kDetection : OverlayLayer::kPrediction,
           OutlineOf(region->box_px),
           fmt::format("{} {:.2f}", ToString(region->state), region->probability)}};
}

ViewStatus FollowStatus(const FollowObservation& observation) {
  ViewStatus status;
  status.state = observation.region ? ToString(observation.region->state) : "not marked";
  if (!observation.world_from_camera) {
    status.reason = "where the UAV was is not known";
  } else if (observation.bearing && !observation.place) {
    status.reason = "too near to the horizon to locate it on the ground";
  }
  return status;
}

std::vector<ViewFact> FollowFacts(const FollowObservation& observation) {
  std::vector<ViewFact> facts;
  if (const auto& region = observation.region) {
    facts.push_back(
        {"size", fmt::format("{:.0f} x {:.0f} px", region->box_px.width, region->box_px.height)});
  }
  if (const auto& place = observation.place) {
    facts.push_back(
        {"place", fmt::format("{:.2f}, {:.2f} m", place->position.x(), place->position.y())});
  }
  return facts;
}

ViewMap FollowMap(const FollowObservation& observation) {
  ViewMap map;
  PlaceUav(observation.world_from_camera, &map);
  if (const auto& target = observation.target) {
    map.target =
        ViewMapObject{.label = observation.region ? ToString(observation.region->state) : "",
                      .color = "",
                      .position = target->motion.position().head<2>(),
                      .covariance = target->motion.covariance.topLeftCorner<2, 2>()};
    map.target_velocity = target->motion.velocity().head<2>();
  }
  return map;
}

}  // namespace kestrel
