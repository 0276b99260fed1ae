// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/landing_plots.h"

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "kestrel/app/evaluation/bins.h"

namespace kestrel {
namespace {

constexpr char kTimeLabel[] = "time, s";
constexpr std::array<char, 3> kAxes = {'x', 'y', 'z'};

// Points over time of the 'rows' for which 'value', which returns an optional, has a value.
template <class Rows, class Value>
Points2d OverTime(const Rows& rows, Time start, const Value& value) {
  Points2d points;
  for (const auto& row : rows) {
    if (const std::optional<double> y = value(row)) {
      points.push_back({ToSeconds(row.time - start), *y});
    }
  }
  return points;
}

// The same as a line that does not bridge the gaps in time.
template <class Rows, class Value>
Points2d LineOverTime(const Rows& rows, Time start, const Value& value) {
  constexpr Duration kMaxGap = std::chrono::milliseconds(500);
  Points2d points;
  std::optional<Time> last;
  for (const auto& row : rows) {
    if (last && row.time - *last > kMaxGap) points.push_back({std::nan(""), std::nan("")});
    points.push_back({ToSeconds(row.time - start), value(row)});
    last = row.time;
  }
  return points;
}

bool HasEstimates(const LandingPlotData& data) {
  for (const LandingComparison& c : data.comparisons) {
    if (c.estimate_in_world) return true;
  }
  return false;
}

PlotPanel PositionPanel(const LandingPlotData& data, int axis) {
  PlotPanel panel{kTimeLabel, fmt::format("{}, m", kAxes[axis]), {}};
  panel.series.push_back(
      {"true",
       PlotStyle::kLine,
       LineOverTime(data.patterns, data.start,
                    [&](const auto& row) { return row.world_from_pattern.translation[axis]; }),
       {}});
  panel.series.push_back({"detected",
                          PlotStyle::kPoints,
                          OverTime(data.comparisons, data.start,
                                   [&](const auto& c) -> std::optional<double> {
                                     return c.estimate_in_world
                                                ? std::optional((*c.estimate_in_world)[axis])
                                                : std::nullopt;
                                   }),
                          {}});
  panel.series.push_back(
      {"track",
       PlotStyle::kLine,
       LineOverTime(data.track, data.start,
                    [&](const auto& row) { return row.position_in_world[axis]; }),
       {}});
  return panel;
}

Plot PositionPlot(const LandingPlotData& data) {
  Plot plot{"position", "Position of the target in the world", {}};
  for (int axis = 0; axis < 3; ++axis) plot.panels.push_back(PositionPanel(data, axis));
  return plot;
}

Plot PlanePlot(const LandingPlotData& data) {
  PlotPanel panel{"x (east), m", "y (north), m", {}, /*equal_axes=*/true};
  Points2d truth, detected, track;
  for (const TruePattern& row : data.patterns) {
    truth.push_back(row.world_from_pattern.translation.head<2>());
  }
  for (const LandingComparison& c : data.comparisons) {
    if (c.estimate_in_world) detected.push_back(c.estimate_in_world->head<2>());
  }
  for (const TrackRow& row : data.track) track.push_back(row.position_in_world.head<2>());
  panel.series = {{"true", PlotStyle::kLine, truth, {}},
                  {"detected", PlotStyle::kPoints, detected, {}},
                  {"track", PlotStyle::kLine, track, {}}};
  return {"plane", "Path of the target, seen from above", {panel}};
}

Plot ErrorPlot(const LandingPlotData& data) {
  const auto detected = [&](const auto& get) {
    return OverTime(data.comparisons, data.start, [&](const LandingComparison& c) {
      return c.errors ? get(*c.errors) : std::nullopt;
    });
  };
  using Value = std::optional<double>;
  PlotPanel camera{kTimeLabel, "error in the camera, m", {}};
  camera.series = {{"lateral",
                    PlotStyle::kPoints,
                    detected([](const auto& e) -> Value { return e.lateral_m; }),
                    {}},
                   {"depth",
                    PlotStyle::kPoints,
                    detected([](const auto& e) -> Value { return e.depth_m; }),
                    {}}};
  PlotPanel world{kTimeLabel, "error in the world, m", {}};
  world.series = {{"detected",
                   PlotStyle::kPoints,
                   detected([](const auto& e) -> Value {
                     return e.in_world ? Value(e.in_world->norm()) : std::nullopt;
                   }),
                   {}},
                  {"track",
                   PlotStyle::kLine,
                   LineOverTime(data.track_errors, data.start,
                                [](const TrackErrors& e) { return e.position.norm(); }),
                   {}}};
  PlotPanel center{kTimeLabel, "centre error, px", {}};
  center.series = {{"detected",
                    PlotStyle::kPoints,
                    detected([](const auto& e) -> Value { return e.center_px; }),
                    {}}};
  return {"error", "Errors over time", {world, camera, center}};
}

Plot RatePlot(const LandingPlotData& data) {
  std::map<std::string, PlotSeries> by_condition;
  for (std::size_t bin = 0; bin < kAltitudeBins.size(); ++bin) {
    std::map<std::string, std::pair<int, int>> counts;  // found, visible
    for (const LandingComparison& c : data.comparisons) {
      if (!c.IsVisible() || !kAltitudeBins[bin].Contains(c.truth->altitude_m)) continue;
      counts[c.condition].first += c.verdict == LandingVerdict::kFound;
      ++counts[c.condition].second;
    }
    for (const auto& [condition, count] : counts) {
      const auto [found, visible] = count;
      PlotSeries& series = by_condition[condition];
      const double low = kAltitudeBins[bin].low;
      const double high = std::min(kAltitudeBins[bin].high, low + 5);
      const Interval interval = WilsonInterval(found, visible);
      series.points.push_back({(low + high) / 2, 100.0 * found / visible});
      series.bars.push_back({100 * interval.low, 100 * interval.high});
    }
  }
  PlotPanel panel{"altitude, m", "found, %", {}};
  panel.y_range = {0, 105};
  for (auto& [condition, series] : by_condition) {
    series.label = condition;
    series.style = PlotStyle::kErrorBars;
    panel.series.push_back(std::move(series));
  }
  return {"rate", "Success rate by altitude, with 95 % intervals", {panel}};
}

Plot ConsistencyPlot(const LandingPlotData& data) {
  PlotPanel panel{kTimeLabel, "NEES of the position", {}};
  panel.series.push_back({"detected",
                          PlotStyle::kPoints,
                          OverTime(data.comparisons, data.start,
                                   [](const LandingComparison& c) -> std::optional<double> {
                                     return c.errors ? std::optional(c.errors->nees) : std::nullopt;
                                   }),
                          {}});
  const Interval bounds = ChiSquareBounds(3);
  const double end_s = ToSeconds(data.comparisons.back().time - data.start);
  panel.series.push_back({"95 % bounds",
                          PlotStyle::kDashes,
                          {{0, bounds.low},
                           {end_s, bounds.low},
                           {std::nan(""), std::nan("")},
                           {0, bounds.high},
                           {end_s, bounds.high}},
                          {}});
  panel.y_range = {0, 4 * bounds.high};
  return {"nees", "Consistency of the reported covariance", {panel}};
}

Plot VelocityPlot(const LandingPlotData& data) {
  Plot plot{"velocity", "Velocity of the target in the world", {}};
  for (int axis = 0; axis < 2; ++axis) {
    PlotPanel panel{kTimeLabel, fmt::format("v {}, m/s", kAxes[axis]), {}};
    panel.series = {{"true",
                     PlotStyle::kLine,
                     LineOverTime(data.patterns, data.start,
                                  [&](const auto& row) { return row.velocity_in_world[axis]; }),
                     {}},
                    {},
                    {"track",
                     PlotStyle::kLine,
                     LineOverTime(data.track, data.start,
                                  [&](const auto& row) { return row.velocity_in_world[axis]; }),
                     {}}};
    plot.panels.push_back(panel);
  }
  PlotPanel error{kTimeLabel, "error, m/s", {}};
  error.series = {
      {},
      {},
      {"track",
       PlotStyle::kLine,
       LineOverTime(data.track_errors, data.start, [](const auto& e) { return e.velocity.norm(); }),
       {}}};
  plot.panels.push_back(error);
  return plot;
}

Plot PredictionPlot(const LandingPlotData& data) {
  std::map<Duration, std::vector<PredictionErrors>> by_horizon;
  for (const PredictionErrors& e : data.prediction_errors) by_horizon[e.horizon].push_back(e);
  PlotPanel panel{kTimeLabel, "error of the predicted position, m", {}};
  for (const auto& [horizon, errors] : by_horizon) {
    panel.series.push_back(
        {fmt::format("{:g} s ahead", ToSeconds(horizon)),
         PlotStyle::kLine,
         LineOverTime(errors, data.start, [](const auto& e) { return e.position.norm(); }),
         {}});
  }
  return {"prediction", "Errors of the prediction", {panel}};
}

}  // namespace

std::vector<Plot> LandingPlots(const LandingPlotData& data) {
  std::vector<Plot> plots;
  if (!data.patterns.empty() && !data.comparisons.empty()) plots.push_back(RatePlot(data));
  if (HasEstimates(data)) {
    plots.push_back(PositionPlot(data));
    plots.push_back(PlanePlot(data));
    plots.push_back(ErrorPlot(data));
    plots.push_back(ConsistencyPlot(data));
  }
  if (!data.track.empty()) plots.push_back(VelocityPlot(data));
  if (!data.prediction_errors.empty()) plots.push_back(PredictionPlot(data));
  return plots;
}

}  // namespace kestrel
