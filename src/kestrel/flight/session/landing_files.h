// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <optional>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/flight/session/observation_sink.h"
#include "kestrel/flight/session/result_files.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// The files of the track: landing_track.csv and landing_prediction.csv.
class TrackFiles {
 public:
  TrackFiles(const OutputFolder& folder, const std::vector<double>& horizons_s);

  void Write(const LandingObservation& observation, const TargetTracker& tracker);

 private:
  std::ofstream track_, prediction_;
  std::vector<Duration> horizons_;
  bool has_begun_ = false;
};

// Writes the results of a landing: detections, track, predictions and annotated frames. Waits for
// the disk. Throws InputError when it cannot write.
class LandingFiles : public ObservationSink {
 public:
  // 'pipeline': the one that gives the observations; outlives this. Predictions and annotated
  // frames are of its present state. 'has_track': the target can be tracked. 'predict_s': horizons
  // of the predictions.
  LandingFiles(const OutputOptions& output, const LandingPipeline* pipeline, bool has_track,
               const std::vector<double>& predict_s);

  void Take(const Observation& observation) override;
  void Take(const BrokenFrame& frame) override;

 private:
  const LandingPipeline* pipeline_;
  bool only_in_image_;
  ResultFiles results_;
  std::optional<TrackFiles> track_;
};

}  // namespace kestrel
