// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/app/ros_node/node_task.h"
#include "kestrel/flight/ros/landing_results.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// The search for the landing pattern.
class LandingTask : public NodeTask {
 public:
  // Parameters and errors as in MakeNodeTask.
  LandingTask(const CameraCalibration& calibration, const NodeOptions& options,
              const NodeFrames& frames, NodeConnection* connection);

  Duration pose_lead() const override { return clock_offset_; }
  void AddPose(const PoseSample& pose) override { pipeline_.AddPose(pose); }
  Found PublishDetections(const Frame& frame) override;
  void PublishRest(const Frame& frame) override;
  void Update(const NodeOptions& options) override;
  void PublishMap() override {}
  std::string SaveMap() override;

 private:
  NodeFrames frames_;
  NodeConnection* connection_;
  Duration clock_offset_;
  LandingPipeline pipeline_;
  LandingResults results_;
  LandingObservation observation_;  // observation of the last frame
};

}  // namespace kestrel
