// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/landing_tables.h"

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "kestrel/app/evaluation/bins.h"
#include "kestrel/app/evaluation/statistics.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Counts of images.
struct Tally {
  int images = 0;
  int found = 0;
  int false_detections = 0;

  void Add(const LandingComparison& comparison) {
    ++images;
    found += comparison.verdict == LandingVerdict::kFound;
    false_detections += comparison.verdict == LandingVerdict::kFalse;
  }
  std::vector<std::string> Cells() const {
    const double rate = images == 0 ? std::nan("") : static_cast<double>(found) / images;
    return {std::to_string(images), std::to_string(found), FormatPercent(rate),
            FormatPercent(WilsonInterval(found, images)), std::to_string(false_detections)};
  }
};

std::vector<std::string> Joined(std::vector<std::string> head,
                                const std::vector<std::string>& tail) {
  head.insert(head.end(), tail.begin(), tail.end());
  return head;
}

template <class Wanted>
Tally TallyOf(std::span<const LandingComparison> comparisons, const Wanted& wanted) {
  Tally tally;
  for (const LandingComparison& comparison : comparisons) {
    if (wanted(comparison)) tally.Add(comparison);
  }
  return tally;
}

void AddConditionRows(std::span<const LandingComparison> comparisons, const std::string& condition,
                      ReportTable* table) {
  const auto add_row = [&](const std::string& altitude, const Tally& tally) {
    if (tally.images == 0) return;
    table->rows.push_back(Joined({condition, altitude}, tally.Cells()));
  };
  const auto is_counted = [&](const LandingComparison& c) {
    return c.condition == condition && c.IsVisible();
  };
  for (const Bin& bin : kAltitudeBins) {
    add_row(bin.Label(), TallyOf(comparisons, [&](const LandingComparison& c) {
              return is_counted(c) && bin.Contains(c.truth->altitude_m);
            }));
  }
  add_row("all", TallyOf(comparisons, is_counted));
  const Tally unseen = TallyOf(comparisons, [&](const LandingComparison& c) {
    return c.condition == condition && !c.IsVisible();
  });
  if (unseen.images == 0) return;
  table->rows.push_back({condition, "not in view", std::to_string(unseen.images), kUnknownCell,
                         kUnknownCell, kUnknownCell, std::to_string(unseen.false_detections)});
}

using Measure = std::function<std::optional<double>(const LandingComparison&)>;

ReportTable RateTable(std::span<const LandingComparison> comparisons, ReportTable table,
                      const std::vector<Bin>& bins, const Measure& measure) {
  table.columns =
      Joined({table.columns.front()}, {"images", "found", "rate, %", "95 % interval, %", "false"});
  for (const Bin& bin : bins) {
    const Tally tally = TallyOf(comparisons, [&](const LandingComparison& c) {
      if (!c.truth || c.truth->visible_fraction == 0) return false;
      const std::optional<double> value = measure(c);
      return value && bin.Contains(*value);
    });
    if (tally.images > 0) table.rows.push_back(Joined({bin.Label()}, tally.Cells()));
  }
  return table;
}

// Errors of one kind for the images of an altitude.
template <class Get>
std::vector<double> ErrorsOf(std::span<const LandingComparison> comparisons, const Bin& bin,
                             const Get& get) {
  std::vector<double> values;
  for (const LandingComparison& comparison : comparisons) {
    if (!comparison.errors || !bin.Contains(comparison.truth->altitude_m)) continue;
    if (const std::optional<double> value = get(*comparison.errors)) values.push_back(*value);
  }
  return values;
}

std::vector<std::string> ErrorCells(std::span<const LandingComparison> comparisons,
                                    const Bin& bin) {
  using Value = std::optional<double>;
  const auto center =
      ErrorsOf(comparisons, bin, [](const auto& e) -> Value { return e.center_px; });
  const auto lateral =
      ErrorsOf(comparisons, bin, [](const auto& e) -> Value { return e.lateral_m; });
  const auto depth =
      ErrorsOf(comparisons, bin, [](const auto& e) -> Value { return std::abs(e.depth_m); });
  const auto world = ErrorsOf(comparisons, bin, [](const auto& e) -> Value {
    return e.in_world ? Value(e.in_world->norm()) : std::nullopt;
  });
  const auto yaw = ErrorsOf(comparisons, bin, [](const auto& e) -> Value {
    return e.yaw ? Value(Degrees(std::abs(*e.yaw))) : std::nullopt;
  });
  return {std::to_string(center.size()),
          FormatFixed(Median(center), 2),
          FormatFixed(Quantile(center, 0.95), 2),
          FormatFixed(Median(lateral), 3),
          FormatFixed(Quantile(lateral, 0.95), 3),
          FormatFixed(Median(depth), 3),
          FormatFixed(Quantile(depth, 0.95), 3),
          FormatFixed(RootMeanSquare(world), 3),
          FormatFixed(Median(world), 3),
          FormatFixed(Quantile(world, 0.95), 3),
          FormatFixed(Median(yaw), 2),
          FormatFixed(Quantile(yaw, 0.95), 2)};
}

// The bins of altitude and one for all of them, each with its label.
std::vector<std::pair<Bin, std::string>> AltitudeRows() {
  std::vector<std::pair<Bin, std::string>> rows;
  for (const Bin& bin : kAltitudeBins) rows.emplace_back(bin, bin.Label());
  rows.emplace_back(Bin{-kInfinity, kInfinity}, "all");
  return rows;
}

}  // namespace

ReportTable SuccessTable(std::span<const LandingComparison> comparisons) {
  ReportTable table{
      "success",
      "Success rate of detection (Table 2)",
      "Images that show at least a quarter of the pattern; false: something else was "
      "taken for it.",
      {"condition", "altitude, m", "images", "found", "rate, %", "95 % interval, %", "false"},
      {}};
  std::set<std::string> conditions;
  for (const LandingComparison& c : comparisons) conditions.insert(c.condition);
  for (const std::string& condition : conditions) AddConditionRows(comparisons, condition, &table);
  return table;
}

ReportTable VisibleFractionTable(std::span<const LandingComparison> comparisons) {
  return RateTable(comparisons,
                   {"visible", "Success rate by the part of the pattern in view", "", {"part"}, {}},
                   {{0, 0.25}, {0.25, 0.5}, {0.5, 0.75}, {0.75, 1}, {1, 1}},
                   [](const LandingComparison& c) { return c.truth->visible_fraction; });
}

ReportTable TiltTable(std::span<const LandingComparison> comparisons) {
  return RateTable(comparisons,
                   {"tilt",
                    "Success rate by the tilt of the UAV",
                    "With at least a quarter of the pattern in view.",
                    {"tilt, degrees"},
                    {}},
                   {{0, 10}, {10, 20}, {20, 30}, {30, kInfinity}},
                   [](const LandingComparison& c) -> std::optional<double> {
                     if (!c.IsVisible() || !c.tilt) return std::nullopt;
                     return Degrees(*c.tilt);
                   });
}

ReportTable MotionTable(std::span<const LandingComparison> comparisons) {
  return RateTable(
      comparisons,
      {"motion",
       "Success rate by motion blur",
       "Motion of the pattern's centre in the image during the exposure, with at least a quarter "
       "of the pattern in view.",
       {"motion, px"},
       {}},
      {{0, 1}, {1, 2}, {2, 4}, {4, 8}, {8, kInfinity}},
      [](const LandingComparison& c) -> std::optional<double> {
        return c.IsVisible() ? c.motion_px : std::nullopt;
      });
}

ReportTable ErrorTable(std::span<const LandingComparison> comparisons) {
  ReportTable table{"errors",
                    "Errors of what was found",
                    "Lateral and depth: of the position in the camera, across and along the line "
                    "of sight. World: with the reported poses of the UAV.",
                    {"altitude, m", "found", "centre median, px", "95 %, px", "lateral median, m",
                     "95 %, m", "depth median, m", "95 %, m", "world RMS, m", "median, m",
                     "95 %, m", "yaw median, degrees", "95 %, degrees"},
                    {}};
  for (const auto& [bin, label] : AltitudeRows()) {
    std::vector<std::string> cells = ErrorCells(comparisons, bin);
    if (cells.front() != "0") table.rows.push_back(Joined({label}, cells));
  }
  return table;
}

ReportTable ConsistencyTable(std::span<const LandingComparison> comparisons) {
  ReportTable table{
      "nees",
      "Consistency: normalised error squared (NEES)",
      "Of the position in the camera against the reported standard deviations of its "
      "three axes: 3 is right, more: the errors are larger than reported. The bounds "
      "are for axes that are independent; their correlation is not in the output. "
      "Successive images have errors in common: independent is how many that "
      "have none say as much of the mean.",
      {"altitude, m", "found", "independent", "mean", "95 % bounds of the mean", "median"},
      {}};
  for (const auto& [bin, label] : AltitudeRows()) {
    const std::vector<double> nees = ErrorsOf(
        comparisons, bin, [](const LandingErrors& e) -> std::optional<double> { return e.nees; });
    if (nees.empty()) continue;
    const int independent = IndependentCount(nees);
    const Interval bounds = MeanNeesBounds(independent, 3);
    table.rows.push_back({label, std::to_string(nees.size()), std::to_string(independent),
                          FormatFixed(Mean(nees), 2),
                          FormatFixed(bounds.low, 2) + " to " + FormatFixed(bounds.high, 2),
                          FormatFixed(Median(nees), 2)});
  }
  return table;
}

}  // namespace kestrel
