// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/hunt_results.h"

#include <utility>

#include "kestrel/flight/ros/hunt_messages.h"
#include "kestrel/flight/ros/landing_messages.h"
#include "kestrel/io/recording/overlays/object_overlay.h"

namespace kestrel {

HuntResults::HuntResults(HuntResultsOptions options, ResultConnection* connection)
    : options_(std::move(options)), connection_(connection) {}

void HuntResults::PublishDetections(const HuntObservation& observation) {
  Publish(ResultTopic::kDetections,
          DetectionsOf(observation, options_.model, options_.camera_frame));
}

void HuntResults::PublishMarkers(const HuntObservation& observation) {
  if (!options_.world_frame || !connection_->HasSubscribers(ResultTopic::kMarkers)) return;
  Publish(ResultTopic::kMarkers, MarkersOf(observation, options_.model, *options_.world_frame));
}

void HuntResults::PublishImage(const cv::Mat& image, const HuntObservation& observation) {
  if (!connection_->HasSubscribers(ResultTopic::kAnnotatedImage)) return;
  const cv::Mat annotated = DrawObjectOverlay(image, options_.model, observation);
  Publish(ResultTopic::kAnnotatedImage,
          ImageMessageOf(annotated, observation.time, options_.camera_frame));
}

void HuntResults::PublishTeam(const TeamReport& team) {
  if (!options_.world_frame) return;
  Publish(ResultTopic::kTeamMap, TeamDetectionsOf(team, options_.model, *options_.world_frame));
  Publish(ResultTopic::kTeamMarkers, TeamMarkersOf(team, options_.model, *options_.world_frame));
}

}  // namespace kestrel
