// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/onboard/live_session.h"
#include "kestrel/flight/ros/node_connection.h"
#include "kestrel/flight/ros/node_options.h"
#include "kestrel/flight/ros/ros_results.h"
#include "kestrel/flight/ros/topic_source.h"
#include "kestrel/flight/session/observation_sink.h"
#include "kestrel/flight/session/observation_sinks.h"
#include "kestrel/vision/objects/color/color_grid.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// The content of the files that the options name.
struct NodeFiles {
  std::optional<CameraCalibration> calibration;  // nothing: it comes from camera_info
  std::optional<ObjectModel> model;              // of the hunt; the built-in one without a file
  std::optional<ColorGrid> grid;
};

// Calls 'warn' with what of the files is not used. Throws InputError when a file is not valid.
NodeFiles ReadNodeFiles(const NodeOptions& options,
                        const std::function<void(const std::string&)>& warn);

// A LiveSession in a thread of its own, with its results on topics. It ends with its destruction.
class NodeSession {
 public:
  // 'source' and 'connection' must outlive this. Throws InputError when calibration or options are
  // not valid.
  NodeSession(const NodeOptions& options, const NodeFiles& files,
              const CameraCalibration& calibration, TopicSource* source,
              NodeConnection* connection);
  ~NodeSession();

  // Continues with options that UpdateOptions has taken over; track and map stay.
  void Change(const NodeOptions& options);
  // Publishes the map as of the newest frame, unless it has been published.
  void PublishMap();
  // Writes the map to the options' folder and returns a text that says what it wrote. Throws
  // InputError when there is no map or it cannot be written.
  std::string SaveMap(const NodeOptions& options);

  FlightReport Report() const { return session_->Report(); }
  ResultCounts Counts() const { return results_->Counts(); }

 private:
  std::shared_ptr<RosResults> results_;
  ObservationSinks sinks_;
  std::optional<LiveSession> session_;
  std::optional<Time> published_;  // the newest frame of the map that was published
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

}  // namespace kestrel
