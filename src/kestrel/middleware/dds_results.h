// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/base/time.h"
#include "kestrel/camera/calibration.h"
#include "kestrel/dds/ros2_node.h"
#include "kestrel/middleware/dds_options.h"
#include "kestrel/middleware/hunt_results.h"
#include "kestrel/middleware/landing_results.h"
#include "kestrel/middleware/result_connection.h"
#include "kestrel/objects/object_model.h"
#include "kestrel/onboard/flight_observer.h"
#include "kestrel/pipeline/hunt_pipeline.h"
#include "kestrel/pipeline/landing_pipeline.h"
#include "kestrel/recording/frame.h"

namespace kestrel {

// By what frames the results are published, and what they are about.
struct DdsFrames {
  std::string camera;
  std::optional<std::string> world;  // where there are poses
  std::optional<std::string> body;   // tell tf of the UAV and the mount; nothing: others do
  Duration to_stamps{};              // from the time of frames to that of stamps
};

// What has to be added to times by Now() to get ROS' time, which is that of the day, as it is now.
Duration RosTimeAhead();

// What the pipelines find, on topics of ROS 2: what the node of ROS 1 publishes, by the same names
// (docs/ros2.md). One thread at a time.
class DdsResults {
 public:
  // Throws InputError where DDS refuses.
  DdsResults(std::shared_ptr<Ros2Node> node, const DdsOptions& options, const DdsFrames& frames,
             const CameraCalibration& calibration, const LandingPipelineOptions& landing,
             ObjectModel model);
  DdsResults(const DdsResults&) = delete;
  DdsResults& operator=(const DdsResults&) = delete;

  // There is a team: its map gets topics of its own, kept for those that come late. Before anything
  // is published.
  void AdvertiseTeam();

  // Until somebody hears, but not longer: who is there is found after a moment only.
  void WaitForSubscribers(Duration timeout) const;

  void Publish(const Frame& frame, const LandingObservation& observation);
  void Publish(const Frame& frame, const HuntObservation& observation);
  // The team's map, where AdvertiseTeam was called and the frames have a world.
  void Publish(const TeamReport& team);
  // Rates since the last call.
  void Publish(const FlightReport& report);

  // Waits until all that hear have all.
  void Flush() const { connection_.node->Flush(std::chrono::seconds(1)); }

 private:
  struct Connection : public ResultConnection {
    Connection(std::shared_ptr<Ros2Node> of, const std::string& name);
    bool HasSubscribers(ResultTopic topic) const override;
    void Publish(ResultTopic topic, const std::string& bytes) override;

    std::shared_ptr<Ros2Node> node;
    std::vector<std::size_t> publishers;  // by ResultTopic
  };

  // Publishers of the node.
  struct TeamTopics {
    std::size_t map;
    std::size_t markers;
  };

  void PublishMount() const;
  void PublishBody(const std::optional<RigidTransform>& world_from_camera, Time stamp);

  DdsOptions options_;
  DdsFrames frames_;
  std::optional<RigidTransform> body_from_camera_;
  CameraModel camera_;
  Connection connection_;
  std::optional<TeamTopics> team_;
  LandingResults landing_;
  HuntResults hunt_;
  Time reported_;
  std::uint64_t reported_frames_ = 0;
};

}  // namespace kestrel
