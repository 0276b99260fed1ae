// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/landing_files.h"

#include <variant>

#include "kestrel/io/recording/overlays/landing_overlay.h"
#include "kestrel/io/recording/tables/landing_csv.h"
#include "kestrel/io/recording/tables/track_csv.h"

namespace kestrel {
namespace {

constexpr char kTrack[] = "landing_track.csv";
constexpr char kPrediction[] = "landing_prediction.csv";

// Places of the target in the second from 'time' on, nothing without a track.
std::vector<Eigen::Vector3d> NextSecond(const TargetTracker& tracker, Time time) {
  constexpr int kSteps = 5;
  constexpr Duration kStep = std::chrono::milliseconds(200);
  std::vector<Eigen::Vector3d> places;
  if (tracker.StateAt(time) == TrackState::kSearching) return places;
  for (int i = 0; i <= kSteps; ++i) {
    if (const auto target = tracker.Predict(time + i * kStep)) {
      places.emplace_back(target->motion.position());
    }
  }
  return places;
}

}  // namespace

TrackFiles::TrackFiles(const OutputFolder& folder, const std::vector<double>& horizons_s)
    : track_(folder.OpenText(kTrack)) {
  WriteAtOnce(TrackCsvHeader(), kTrack, &track_);
  if (horizons_s.empty()) return;
  for (const double horizon_s : horizons_s) horizons_.push_back(DurationFromSeconds(horizon_s));
  prediction_ = folder.OpenText(kPrediction);
  WriteAtOnce(PredictionCsvHeader(), kPrediction, &prediction_);
}

void TrackFiles::Write(const LandingObservation& observation, const TargetTracker& tracker) {
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

LandingFiles::LandingFiles(const OutputOptions& output, const LandingPipeline* pipeline,
                           bool has_track, const std::vector<double>& predict_s,
                           const std::vector<std::string>& further)
    : pipeline_(pipeline), only_in_image_(output.only_in_image) {
  results_.push_back(std::make_unique<ResultFiles>(output, kLandingTable, LandingCsvHeader()));
  const OutputFolder* const folder = results_.front()->folder();
  if (!folder) return;
  if (has_track) track_.emplace(*folder, predict_s);
  for (std::size_t i = 0; i < further.size(); ++i) {
    OutputOptions own = output;
    if (i < output.further_rates_hz.size()) own.rate_hz = output.further_rates_hz[i];
    results_.push_back(
        std::make_unique<ResultFiles>(own, kLandingTable, LandingCsvHeader(), "_" + further[i]));
  }
}

void LandingFiles::Take(const Observation& observation) {
  const Frame& frame = observation.frame;
  const auto& seen = std::get<LandingObservation>(observation.seen);
  ResultFiles& results = ResultsOf(frame.camera);
  results.WriteRows(LandingCsvRow(frame, seen, only_in_image_));
  if (track_) track_->Write(seen, pipeline_->tracker());
  if (!results.wants_pictures()) return;
  const TargetDetector& detector = pipeline_->detector(frame.camera);
  results.WritePicture(
      frame.name,
      DrawLandingOverlay(frame.color.empty() ? frame.image : frame.color, detector.camera(),
                         detector.shape(), seen,
                         {only_in_image_, NextSecond(pipeline_->tracker(), seen.time)}));
}

void LandingFiles::Take(const BrokenFrame& frame) {
  ResultsOf(frame.camera).WriteRows(UnreadableLandingCsvRow(frame.name, frame.time));
}

}  // namespace kestrel
