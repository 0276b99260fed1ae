// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/app/ros_node/node_task.h"
#include "kestrel/flight/ros/hunt_results.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// The hunt for coloured objects, with their map.
class HuntTask : public NodeTask {
 public:
  // Parameters and errors as in MakeNodeTask.
  HuntTask(const CameraCalibration& calibration, const HuntedObjects& objects,
           const NodeOptions& options, const NodeFrames& frames, NodeConnection* connection);

  Duration pose_lead() const override;
  void AddPose(const PoseSample& pose) override { pipeline_.AddPose(pose); }
  Found PublishDetections(const Frame& frame) override;
  void PublishRest(const Frame& frame) override;
  void Update(const NodeOptions& options) override;
  void PublishMap() override;
  std::string SaveMap() override;

 private:
  NodeOptions options_;
  bool has_world_;
  Duration clock_offset_;
  HuntPipeline pipeline_;
  HuntResults results_;
  const HuntObservation* observation_ = nullptr;  // observation of the last frame
  bool is_map_published_ = false;
};

}  // namespace kestrel
