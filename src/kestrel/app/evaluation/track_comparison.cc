// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/track_comparison.h"

#include <algorithm>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "kestrel/app/evaluation/bins.h"
#include "kestrel/app/evaluation/statistics.h"

namespace kestrel {
namespace {

double AltitudeAt(const std::vector<TruePattern>& patterns, Time time) {
  const auto after = std::upper_bound(patterns.begin(), patterns.end(), time,
                                      [](Time t, const TruePattern& row) { return t < row.time; });
  return after == patterns.begin() ? patterns.front().altitude_m : (after - 1)->altitude_m;
}

std::vector<std::string> TrackCells(std::span<const TrackErrors> errors, const Bin& bin) {
  std::vector<double> position, velocity, position_nees, velocity_nees;
  for (const TrackErrors& e : errors) {
    if (!bin.Contains(e.altitude_m)) continue;
    position.push_back(e.position.norm());
    velocity.push_back(e.velocity.norm());
    position_nees.push_back(e.position_nees);
    velocity_nees.push_back(e.velocity_nees);
  }
  return {bin.Label(),
          std::to_string(position.size()),
          FormatFixed(RootMeanSquare(position), 3),
          FormatFixed(Quantile(position, 0.95), 3),
          FormatFixed(RootMeanSquare(velocity), 3),
          FormatFixed(Quantile(velocity, 0.95), 3),
          FormatFixed(Mean(position_nees), 2),
          FormatFixed(Mean(velocity_nees), 2)};
}

}  // namespace

std::vector<TrackErrors> CompareTrack(const std::vector<TruePattern>& patterns,
                                      const std::vector<TrackRow>& rows) {
  std::vector<TrackErrors> errors;
  for (const TrackRow& row : rows) {
    const std::optional<TrueMotion> truth = TrueMotionAt(patterns, row.time);
    if (!truth || row.state == "searching") continue;
    TrackErrors e;
    e.time = row.time;
    e.altitude_m = AltitudeAt(patterns, row.time);
    e.position = row.position_in_world - truth->position_in_world;
    e.velocity = row.velocity_in_world - truth->velocity_in_world;
    e.position_nees = e.position.squaredNorm() / (row.position_sigma_m * row.position_sigma_m);
    e.velocity_nees = e.velocity.squaredNorm() / (row.velocity_sigma_mps * row.velocity_sigma_mps);
    errors.push_back(e);
  }
  return errors;
}

std::vector<PredictionErrors> ComparePredictions(const std::vector<TruePattern>& patterns,
                                                 const std::vector<PredictionRow>& rows) {
  std::vector<PredictionErrors> errors;
  for (const PredictionRow& row : rows) {
    const Time time = row.time + row.horizon;
    const std::optional<TrueMotion> truth = TrueMotionAt(patterns, time);
    if (!truth) continue;
    errors.push_back({time, row.horizon, row.position_in_world - truth->position_in_world});
  }
  return errors;
}

ReportTable TrackTable(std::span<const TrackErrors> errors) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  ReportTable table{"track",
                    "Errors of the track",
                    "In the world. NEES against the one standard deviation of all three axes that "
                    "the output has: 3 is right. The velocity is the board's: where it sways on "
                    "its vehicle by more than landing.tracker.sway_sigma_m, the track follows the "
                    "vehicle, and the NEES of the velocity is larger.",
                    {"altitude, m", "rows", "position RMS, m", "95 %, m", "velocity RMS, m/s",
                     "95 %, m/s", "position NEES, mean", "velocity NEES, mean"},
                    {}};
  for (const Bin& bin : kAltitudeBins) {
    std::vector<std::string> cells = TrackCells(errors, bin);
    if (cells[1] != "0") table.rows.push_back(std::move(cells));
  }
  table.rows.push_back(TrackCells(errors, {-kFar, kFar}));
  table.rows.back().front() = "all";
  return table;
}

ReportTable PredictionTable(std::span<const PredictionErrors> errors) {
  ReportTable table{"prediction",
                    "Errors of the prediction",
                    "Of the predicted position in the world.",
                    {"horizon, s", "predictions", "RMS, m", "median, m", "95 %, m"},
                    {}};
  std::map<Duration, std::vector<double>> by_horizon;
  for (const PredictionErrors& e : errors) by_horizon[e.horizon].push_back(e.position.norm());
  for (const auto& [horizon, values] : by_horizon) {
    table.rows.push_back({fmt::format("{:g}", ToSeconds(horizon)), std::to_string(values.size()),
                          FormatFixed(RootMeanSquare(values), 3), FormatFixed(Median(values), 3),
                          FormatFixed(Quantile(values, 0.95), 3)});
  }
  return table;
}

}  // namespace kestrel
