// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/follow_results.h"

#include <utility>

#include "kestrel/flight/ros/landing_messages.h"
#include "kestrel/io/recording/overlays/follow_overlay.h"
#include "kestrel/io/ros_messages/serialization.h"

namespace kestrel {

FollowResults::FollowResults(FollowResultsOptions options, ResultConnection* connection)
    : options_(std::move(options)), connection_(connection) {}

void FollowResults::PublishTrack(const FollowObservation& observation) {
  if (!options_.world_frame || !observation.target) return;
  connection_->Publish(
      ResultTopic::kTrack,
      SerializeMessage(TrackOf(*observation.target, *options_.world_frame, options_.target_frame),
                       WireFormat::kCdr));
}

void FollowResults::PublishImage(const cv::Mat& image, const FollowObservation& observation) {
  if (!connection_->HasSubscribers(ResultTopic::kAnnotatedImage)) return;
  connection_->Publish(ResultTopic::kAnnotatedImage,
                       SerializeMessage(ImageMessageOf(DrawFollowOverlay(image, observation),
                                                       observation.time, options_.camera_frame),
                                        WireFormat::kCdr));
}

}  // namespace kestrel
