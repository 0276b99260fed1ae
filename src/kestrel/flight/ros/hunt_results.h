// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"
#include "kestrel/flight/ros/result_connection.h"
#include "kestrel/flight/session/flight_report.h"
#include "kestrel/io/bags/serialization.h"
#include "kestrel/vision/mapping/mapped_object.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// Names of the published frames and format, and the model of the objects.
struct HuntResultsOptions {
  WireFormat format = WireFormat::kRos1;
  std::string camera_frame;
  std::optional<std::string> world_frame;  // where there are poses
  ObjectModel model;
};

// Publishes the results of the pipeline of coloured objects for a frame, and its map. Messages for
// display are made only when somebody subscribes to them.
class HuntResults {
 public:
  // 'connection' must outlive this.
  HuntResults(HuntResultsOptions options, ResultConnection* connection);

  void PublishDetections(const HuntObservation& observation);
  void PublishMarkers(const HuntObservation& observation);
  // The image with the results drawn on it, and the map in a corner, unless it is empty.
  void PublishImage(const cv::Mat& image, const HuntObservation& observation,
                    const std::vector<MappedObject>& map);
  // The map at 'stamp', and its markers. Nothing where there are no poses.
  void PublishMap(const std::vector<MappedObject>& map, Time stamp);
  // The team's map and its markers, likewise.
  void PublishTeam(const TeamReport& team);

 private:
  template <class Message>
  void Publish(ResultTopic topic, const Message& message) {
    connection_->Publish(topic, SerializeMessage(message, options_.format));
  }

  HuntResultsOptions options_;
  ResultConnection* connection_;
};

}  // namespace kestrel
