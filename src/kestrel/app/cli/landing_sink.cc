// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/landing_sink.h"

#include "kestrel/io/recording/landing_csv.h"
#include "kestrel/io/recording/landing_overlay.h"
#include "kestrel/io/recording/track_csv.h"

namespace kestrel {
namespace {

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

LandingSink::LandingSink(const OutputOptions& output, bool has_track,
                         const std::vector<double>& predict_s)
    : results_(output, "landing_detections.csv", LandingCsvHeader()) {
  if (has_track && results_.folder()) track_.emplace(*results_.folder(), predict_s);
}

void LandingSink::Write(const Frame& frame, const LandingObservation& observation,
                        const LandingPipeline& pipeline) {
  results_.WriteRows(LandingCsvRow(frame.name, observation));
  if (track_) track_->Write(observation, pipeline.tracker());
  if (!results_.wants_pictures()) return;
  const LandingPatternDetector& detector = pipeline.detector();
  results_.WritePicture(frame.name, DrawLandingOverlay(frame.image, detector.camera(),
                                                       detector.options().pattern, observation));
}

}  // namespace kestrel
