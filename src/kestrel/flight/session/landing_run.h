// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "kestrel/flight/session/vision.h"
#include "kestrel/io/bags/open_recording.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// The landing pipeline over a recording.
class LandingRun : public Vision {
 public:
  // 'altitude_m': height of the camera above the pattern, where the source has no poses. Throws
  // InputError when it, the calibration or the options are not valid.
  LandingRun(const OpenedSource& opened, const LandingPipelineOptions& options,
             std::optional<double> altitude_m);

  void AddPose(const PoseSample& pose) override { pipeline_.AddPose(pose); }
  Duration pose_lead() const override { return clock_offset_; }
  Observation Process(const Frame& frame) override;

  // Says how the detections contradict the given height and attitude.
  std::string Warning() const override;
  std::string Found() const override;
  // Contradictions between detections and calibration; the number of frames without a pose, where
  // others have one.
  std::string Remarks() const override;

  const LandingPipeline& pipeline() const { return pipeline_; }

 private:
  LandingPipeline pipeline_;
  Duration clock_offset_;
  std::optional<double> altitude_m_;
  bool has_world_;
  bool is_lens_unknown_;
  std::map<PoseLookup, std::size_t> poses_;
  std::size_t found_ = 0;
  std::optional<OtherTag> other_tag_;
};

}  // namespace kestrel
