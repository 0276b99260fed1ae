// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/flight/session/flight_report.h"
#include "kestrel/flight/session/result_connection.h"
#include "kestrel/io/ros_messages/serialization.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// Names of the published frames, and the model of the objects.
struct HuntResultsOptions {
  std::string camera_frame;
  std::optional<std::string> world_frame;  // where there are poses
  ObjectModel model;
};

// Publishes the results of the pipeline of coloured objects for a frame, and the team's map.
// Messages for display are made only when somebody subscribes to them.
class HuntResults {
 public:
  // 'connection' must outlive this.
  HuntResults(HuntResultsOptions options, ResultConnection* connection);

  void PublishDetections(const HuntObservation& observation);
  void PublishMarkers(const HuntObservation& observation);
  // The image with the results drawn on it.
  void PublishImage(const cv::Mat& image, const HuntObservation& observation);
  // The team's map and its markers. Nothing where there are no poses.
  void PublishTeam(const TeamReport& team);

 private:
  template <class Message>
  void Publish(ResultTopic topic, const Message& message) {
    connection_->Publish(topic, SerializeMessage(message, WireFormat::kCdr));
  }

  HuntResultsOptions options_;
  ResultConnection* connection_;
};

}  // namespace kestrel
