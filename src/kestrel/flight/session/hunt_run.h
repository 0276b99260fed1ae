// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "kestrel/flight/session/vision.h"
#include "kestrel/io/bags/open_recording.h"
#include "kestrel/vision/objects/color/color_grid.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// The pipeline of coloured objects over a recording.
class HuntRun : public Vision {
 public:
  // 'altitude_m': height of the camera above the ground, where the source has no poses. Throws
  // InputError when it, calibration, model or options are not valid.
  HuntRun(const OpenedSource& opened, const ObjectModel& model, const ColorGrid& grid,
          const HuntPipelineOptions& options, std::optional<double> altitude_m);

  void AddPose(const PoseSample& pose) override { pipeline_.AddPose(pose); }
  Duration pose_lead() const override;
  Observation Process(const Frame& frame) override;

  // Says how the objects' sizes contradict the given height of the ground.
  std::string Warning() const override;
  std::string Found() const override;
  // Number of segments left after each step, as in the paper's Table 3.
  std::string Remarks() const override;

  const HuntPipeline& pipeline() const { return pipeline_; }

 private:
  HuntPipeline pipeline_;
  Duration clock_offset_;
  std::optional<double> altitude_m_;
  bool has_world_ = false;   // the last frame had a pose
  bool is_colored_ = false;  // an image in colour has been seen
  std::size_t detections_ = 0;
  std::array<std::size_t, kObjectStageCount> passed_{};
};

}  // namespace kestrel
