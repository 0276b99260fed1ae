// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "kestrel/base/time.h"
#include "kestrel/pipeline/landing_pipeline.h"
#include "kestrel/recording/annotated_writer.h"
#include "kestrel/recording/frame.h"
#include "kestrel/recording/output_folder.h"

namespace kestrel {

// What is written of a landing, and where.
struct LandingSinkOptions {
  std::string folder;             // empty: the detections to stdout, and nothing else
  bool force = false;             // replace files that exist
  std::string annotate;           // "video", "images" or empty
  double rate_hz = 0;             // of the video
  bool has_track = false;         // the target can be followed
  std::vector<double> predict_s;  // horizons of the predictions
};

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

// Writes what the landing pipeline makes of frames: detections, track, predictions, annotated
// frames. Throws InputError when that is not possible.
class LandingSink {
 public:
  explicit LandingSink(const LandingSinkOptions& options);

  void Write(const Frame& frame, const LandingObservation& observation,
             const LandingPipeline& pipeline);

 private:
  std::ostream& csv();

  std::optional<OutputFolder> folder_;
  std::ofstream file_;
  std::optional<TrackSink> track_;
  std::unique_ptr<AnnotatedWriter> annotated_;
};

}  // namespace kestrel
