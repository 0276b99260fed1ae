// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
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

// Writes the results of a landing: detections, track, predictions and annotated frames. Of several
// cameras each has a table of detections and frames of its own; on a stream all rows are in one.
// Waits for the disk. Throws InputError when it cannot write.
class LandingFiles : public ObservationSink {
 public:
  // 'pipeline': the one that gives the observations; outlives this. Predictions and annotated
  // frames are of its present state. 'has_track': the target can be tracked. 'predict_s': horizons
  // of the predictions. 'further': names of the cameras after the first.
  LandingFiles(const OutputOptions& output, const LandingPipeline* pipeline, bool has_track,
               const std::vector<double>& predict_s, const std::vector<std::string>& further = {});

  void Take(const Observation& observation) override;
  void Take(const BrokenFrame& frame) override;

 private:
  const LandingPipeline* pipeline_;
  bool only_in_image_;
  ResultFiles& ResultsOf(std::size_t camera) {
    return *results_[std::min(camera, results_.size() - 1)];
  }
  std::vector<std::unique_ptr<ResultFiles>> results_;  // one for each camera, or one for all
  std::optional<TrackFiles> track_;
};

}  // namespace kestrel
