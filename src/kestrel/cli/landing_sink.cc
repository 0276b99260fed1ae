// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/cli/landing_sink.h"

#include <iostream>

#include "kestrel/recording/landing_csv.h"
#include "kestrel/recording/landing_overlay.h"
#include "kestrel/recording/track_csv.h"

namespace kestrel {
namespace {

constexpr char kDetections[] = "landing_detections.csv";
constexpr char kTrack[] = "landing_track.csv";
constexpr char kPrediction[] = "landing_prediction.csv";

}  // namespace

TrackSink::TrackSink(const OutputFolder& folder, const std::vector<double>& horizons_s)
    : track_(folder.OpenText(kTrack)) {
  WriteAtOnce(TrackCsvHeader(), kTrack, &track_);
  if (horizons_s.empty()) return;
  for (const double horizon_s : horizons_s) horizons_.push_back(DurationFromSeconds(horizon_s));
  prediction_ = folder.OpenText(kPrediction);
  WriteAtOnce(PredictionCsvHeader(), kPrediction, &prediction_);
}

void TrackSink::Write(const LandingObservation& observation, const TargetTracker& tracker) {
  has_begun_ = has_begun_ || observation.fate;
  if (!has_begun_) return;
  WriteAtOnce(TrackCsvRow(observation), kTrack, &track_);
  if (observation.track_state == TrackState::kSearching) return;
  for (const Duration horizon : horizons_) {
    const auto prediction = tracker.Predict(observation.time + horizon);
    if (!prediction) continue;
    WriteAtOnce(PredictionCsvRow(observation.time, *prediction), kPrediction, &prediction_);
  }
}

LandingSink::LandingSink(const LandingSinkOptions& options) {
  if (!options.folder.empty()) {
    folder_.emplace(options.folder, options.force);
    file_ = folder_->OpenText(kDetections);
    if (options.has_track) track_.emplace(*folder_, options.predict_s);
  }
  if (options.annotate == "images") annotated_ = MakeImageWriter(*folder_);
  if (options.annotate == "video") annotated_ = MakeVideoWriter(*folder_, options.rate_hz);
  WriteAtOnce(LandingCsvHeader(), kDetections, &csv());
}

void LandingSink::Write(const Frame& frame, const LandingObservation& observation,
                        const LandingPipeline& pipeline) {
  WriteAtOnce(LandingCsvRow(frame.name, observation), kDetections, &csv());
  if (track_) track_->Write(observation, pipeline.tracker());
  if (!annotated_) return;
  const LandingPatternDetector& detector = pipeline.detector();
  annotated_->Write(frame.name, DrawLandingOverlay(frame.image, detector.camera(),
                                                   detector.options().pattern, observation));
}

std::ostream& LandingSink::csv() { return file_.is_open() ? file_ : std::cout; }

}  // namespace kestrel
