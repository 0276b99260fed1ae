// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/evaluate_landing.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/evaluation/landing_plots.h"
#include "kestrel/app/evaluation/landing_tables.h"
#include "kestrel/app/evaluation/track_comparison.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

// Returns 'parse' of the file's text; an empty result when there is no file.
template <class Parse>
auto ReadIfThere(const fs::path& file, const Parse& parse) -> decltype(parse("", "")) {
  if (!fs::exists(file)) return {};
  return parse(ReadFile(file.string()), file.string());
}

ReportTable ImageTable(const FlightTruth& flight,
                       const std::vector<LandingComparison>& comparisons) {
  const auto count = [&](const auto& wanted) {
    return std::to_string(std::count_if(comparisons.begin(), comparisons.end(), wanted));
  };
  return {"images",
          "Images",
          "",
          {"in the recording", "evaluated", "with the pattern in the scene",
           "with a quarter of it in view", "found", "false"},
          {{std::to_string(flight.frames().size()), std::to_string(comparisons.size()),
            count([](const auto& c) { return c.truth.has_value(); }),
            count([](const auto& c) { return c.IsVisible(); }),
            count([](const auto& c) { return c.verdict == LandingVerdict::kFound; }),
            count([](const auto& c) { return c.verdict == LandingVerdict::kFalse; })}}};
}

}  // namespace

ComparedLanding CompareLandingOutput(const std::string& recording, const std::string& output) {
  FlightTruth flight(recording);
  const std::string truth_file =
      (fs::path(flight.root()) / "landing_pattern0" / "data.csv").string();
  auto patterns = ParseTruePatterns(ReadFile(truth_file), truth_file);
  const std::string file = (fs::path(output) / "landing_detections.csv").string();
  const auto rows = ParseDetectionRows(ReadFile(file), file);
  if (rows.empty()) throw InputError(file + ": no rows, expected one for every image");
  auto comparisons = CompareLanding(flight, patterns, rows, file);
  return {std::move(flight), std::move(patterns), std::move(comparisons)};
}

Report EvaluateLanding(const std::string& recording, const std::string& output) {
  const auto [flight, patterns, comparisons] = CompareLandingOutput(recording, output);
  const fs::path folder(output);
  const auto track = ReadIfThere(folder / "landing_track.csv", ParseTrackRows);
  const auto predictions = ReadIfThere(folder / "landing_prediction.csv", ParsePredictionRows);
  const auto track_errors = CompareTrack(patterns, track);
  const auto prediction_errors = ComparePredictions(patterns, predictions);

  Report report;
  report.title = fmt::format("Landing: {}", fs::path(recording).lexically_normal().string());
  report.tables = {ImageTable(flight, comparisons),   SuccessTable(comparisons),
                   VisibleFractionTable(comparisons), TiltTable(comparisons),
                   MotionTable(comparisons),          ErrorTable(comparisons),
                   ConsistencyTable(comparisons)};
  if (!track_errors.empty()) report.tables.push_back(TrackTable(track_errors));
  if (!prediction_errors.empty()) report.tables.push_back(PredictionTable(prediction_errors));
  report.plots = LandingPlots(
      {flight.frames().front(), patterns, comparisons, track, track_errors, prediction_errors});
  return report;
}

}  // namespace kestrel
