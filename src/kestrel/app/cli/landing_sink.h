// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <optional>
#include <vector>

#include "kestrel/app/cli/result_sink.h"
#include "kestrel/core/base/time.h"
#include "kestrel/io/recording/frame.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// The files of the track.
class TrackSink {
 public:
  TrackSink(const OutputFolder& folder, const std::vector<double>& horizons_s);

  void Write(const LandingObservation& observation, const TargetTracker& tracker);

 private:
  std::ofstream track_, prediction_;
  std::vector<Duration> horizons_;
  bool has_begun_ = false;
};

// Writes the results of the landing pipeline: detections, track, predictions and annotated frames.
// Throws InputError when it cannot write.
class LandingSink {
 public:
  // 'has_track': the target can be tracked. 'predict_s': horizons of the predictions.
  LandingSink(const OutputOptions& output, bool has_track, const std::vector<double>& predict_s);

  void Write(const Frame& frame, const LandingObservation& observation,
             const LandingPipeline& pipeline);

 private:
  ResultSink results_;
  std::optional<TrackSink> track_;
};

}  // namespace kestrel
