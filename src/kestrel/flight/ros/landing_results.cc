// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/landing_results.h"

#include <utility>

#include "kestrel/flight/ros/landing_messages.h"
#include "kestrel/flight/ros/tag_messages.h"
#include "kestrel/io/recording/overlays/landing_overlay.h"

namespace kestrel {

LandingResults::LandingResults(LandingResultsOptions options, ResultConnection* connection)
    : options_(std::move(options)), connection_(connection) {}

void LandingResults::PublishDetection(const CameraModel& camera,
                                      const LandingObservation& observation) {
  Publish(ResultTopic::kDetections,
          DetectionsOf(observation, options_.camera_frame, options_.shape));
  if (options_.apriltag_topics) PublishTags(camera, observation);
  const auto& detection = observation.report.detection;
  if (!detection) return;
  Publish(ResultTopic::kTargetPose,
          TargetPoseOf(*detection, observation.time, options_.camera_frame));
  if (!options_.publish_tf) return;
  Publish(ResultTopic::kTransforms,
          PatternTransformOf(*detection, observation.time, options_.camera_frame,
                             options_.pattern_frame));
}

void LandingResults::PublishTags(const CameraModel& camera, const LandingObservation& observation) {
  Publish(ResultTopic::kTags, TagsOf(observation, camera, options_.shape, options_.camera_frame));
  if (!options_.publish_tf) return;
  const TfMessage transforms = TagTransformsOf(observation, options_.shape, options_.camera_frame);
  if (!transforms.transforms.empty()) Publish(ResultTopic::kTransforms, transforms);
}

void LandingResults::PublishMarkers(const LandingObservation& observation) {
  if (!connection_->HasSubscribers(ResultTopic::kMarkers)) return;
  Publish(ResultTopic::kMarkers,
          MarkersOf(observation, options_.shape, options_.camera_frame, options_.world_frame));
}

void LandingResults::PublishTrack(const LandingObservation& observation) {
  if (!options_.world_frame || !observation.target) return;
  Publish(ResultTopic::kTrack,
          TrackOf(*observation.target, *options_.world_frame, options_.target_frame));
  if (!connection_->HasSubscribers(ResultTopic::kPrediction)) return;
  Publish(ResultTopic::kPrediction,
          PredictionOf(*observation.target, options_.noise, options_.horizon, options_.step,
                       *options_.world_frame));
}

void LandingResults::PublishImage(const cv::Mat& image, const CameraModel& camera,
                                  const LandingObservation& observation) {
  if (!connection_->HasSubscribers(ResultTopic::kAnnotatedImage)) return;
  const cv::Mat annotated = DrawLandingOverlay(image, camera, options_.shape, observation);
  Publish(ResultTopic::kAnnotatedImage,
          ImageMessageOf(annotated, observation.time, options_.camera_frame));
}

}  // namespace kestrel
