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
#include "kestrel/vision/mapping/object_map.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// By what names results are published, and what the objects are.
struct HuntResultsOptions {
  WireFormat format = WireFormat::kRos1;
  std::string camera_frame;
  std::optional<std::string> world_frame;  // where there are poses
  ObjectModel model;
};

// Publishes what the pipeline of coloured objects says of a frame, and its map. What is only looked
// at is made only for those who look.
class HuntResults {
 public:
  // 'connection' must outlive this.
  HuntResults(HuntResultsOptions options, ResultConnection* connection);

  void PublishDetections(const HuntObservation& observation);
  void PublishMarkers(const HuntObservation& observation);
  // With what was found drawn on it, and the map, where it is not null, in a corner.
  void PublishImage(const cv::Mat& image, const HuntObservation& observation, const ObjectMap* map);
  // The map as it was at 'stamp', and its markers. Nothing where there are no poses.
  void PublishMap(const std::vector<MappedObject>& map, Time stamp);
  // The team's, likewise.
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
