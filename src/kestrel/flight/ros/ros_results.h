// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/onboard/latency_statistics.h"
#include "kestrel/flight/ros/dds_options.h"
#include "kestrel/flight/ros/flight_diagnostics.h"
#include "kestrel/flight/ros/follow_results.h"
#include "kestrel/flight/ros/hunt_results.h"
#include "kestrel/flight/ros/landing_results.h"
#include "kestrel/flight/session/flight_report.h"
#include "kestrel/flight/session/result_connection.h"
#include "kestrel/io/recording/frame.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/follow_pipeline.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// Frames in which the results are published.
struct RosFrames {
  std::string camera;
  std::optional<std::string> world;       // where there are poses
  std::optional<std::string> body;        // publish the UAV and the mount on tf; nothing: others do
  Duration to_stamps{};                   // added to a frame's time to get its stamp
  std::vector<std::string> further = {};  // those of the further cameras
};

// Returns the current difference between the ROS time (the time of day) and Now(): add it to a time
// by Now().
Duration RosTimeAhead();

// Publishes the results of the pipelines on topics of ROS 2 (docs/ros2.md). Any thread may call all
// functions.
class RosResults {
 public:
  RosResults(std::shared_ptr<ResultConnection> connection, const DdsOptions& options,
             const RosFrames& frames, const CameraCalibration& calibration,
             const LandingPipelineOptions& landing, ObjectModel model);
  // Adds the next further camera before the first results, with the next of the frames' further
  // ones. Its own topics go to 'connection', with those of tf; its pattern's frame begins with the
  // camera's name. Tags as of apriltag_ros are the first camera's alone.
  void AddCamera(std::shared_ptr<ResultConnection> connection,
                 const CameraCalibration& calibration);

  // Waits until somebody subscribes, at most 'timeout': subscribers are found only after a moment.
  void WaitForSubscribers(Duration timeout) const;

  // The track is that of all cameras; the first one may have failed.
  void Publish(const Frame& frame, const LandingObservation& observation);
  void Publish(const Frame& frame, const HuntObservation& observation);
  void Publish(const Frame& frame, const FollowObservation& observation);
  // The team's map, if the frames have a world; kept for later subscribers.
  void Publish(const TeamReport& team);
  // Publishes the rates since the last call.
  void Publish(const FlightReport& report);

  // Waits until all subscribers have everything.
  void Flush() const { connection_->Flush(); }

 private:
  struct Camera {
    Camera(std::shared_ptr<ResultConnection> to, const CameraCalibration& calibration,
           LandingResultsOptions results);

    std::string frame;
    CameraModel lens;
    std::optional<RigidTransform> body_from_camera;
    bool has_gimbal;
    std::shared_ptr<ResultConnection> connection;
    LandingResults landing;
  };

  void PublishMounts();
  void Count(bool found, Time time, Duration detect_time);
  template <class Observation>
  void PublishTransforms(const Camera& camera, const Observation& observation);

  std::mutex mutex_;  // guards all but the connection
  std::string name_;  // node name
  bool publish_tf_;
  RosFrames frames_;
  LandingResultsOptions landing_;  // of the first camera
  std::shared_ptr<ResultConnection> connection_;
  std::vector<Camera> cameras_;
  std::optional<Time> body_time_;  // stamp of the UAV's newest transform
  HuntResults hunt_;
  FollowResults follow_;
  Rate rate_;
  std::uint64_t found_ = 0;
  LatencyHistogram latency_, beyond_detect_, detect_;
};

}  // namespace kestrel
