// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/flight/session/result_connection.h"
#include "kestrel/io/ros_messages/serialization.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"
#include "kestrel/vision/target/target_shape.h"
#include "kestrel/vision/tracking/turn_motion.h"

namespace kestrel {

// Names of the published results, and the extent of the prediction.
struct LandingResultsOptions {
  std::string camera_frame;
  std::optional<std::string> world_frame;  // where there are poses
  std::string pattern_frame;
  std::string target_frame;
  bool publish_tf = true;
  bool apriltag_topics = false;
  Duration horizon{};  // how far the prediction reaches
  Duration step{};     // between its poses, above 0
  TargetShape shape;
  TurnNoise noise;  // noise of the track's motion
};

// Publishes the results of the landing pipeline for a frame. Messages for display are made only
// when somebody subscribes to them.
class LandingResults {
 public:
  // 'connection' must outlive this.
  LandingResults(LandingResultsOptions options, ResultConnection* connection);

  // 'camera' made the image.
  void PublishDetection(const CameraModel& camera, const LandingObservation& observation);
  void PublishMarkers(const LandingObservation& observation);
  void PublishTrack(const LandingObservation& observation);
  // The image with the results drawn on it.
  void PublishImage(const cv::Mat& image, const CameraModel& camera,
                    const LandingObservation& observation);

 private:
  void PublishTags(const CameraModel& camera, const LandingObservation& observation);

  template <class Message>
  void Publish(ResultTopic topic, const Message& message) {
    connection_->Publish(topic, SerializeMessage(message, WireFormat::kCdr));
  }

  LandingResultsOptions options_;
  ResultConnection* connection_;
};

}  // namespace kestrel
