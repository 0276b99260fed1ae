// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/evaluate_hunt.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/evaluation/object_tables.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

// Returns where the objects were when in view: those that are wanted in the map, or the others.
Points2d Positions(const std::vector<TrueSighting>& sightings, const std::set<int>& wanted,
                   bool is_wanted) {
  Points2d points;
  for (const TrueSighting& s : sightings) {
    if (wanted.contains(s.id) == is_wanted) points.push_back(s.position_in_world.head<2>());
  }
  return points;
}

Points2d Positions(const std::vector<MapRow>& map) {
  Points2d points;
  for (const MapRow& row : map) points.push_back(row.position_in_world.head<2>());
  return points;
}

// Returns a colour for the points of a class, by the word for its colour; empty for other words.
std::string ColorOf(const std::string& class_name) {
  static const std::map<std::string, std::string> kColors = {
      {"red", "#d62728"},    {"green", "#2ca02c"},  {"blue", "#1f77b4"},   {"orange", "#ff7f0e"},
      {"yellow", "#d4c20e"}, {"violet", "#9467bd"}, {"purple", "#9467bd"}, {"pink", "#e377c2"}};
  const auto color = kColors.find(class_name);
  return color == kColors.end() ? "" : color->second;
}

// Returns a series for each class, in its colour.
std::vector<PlotSeries> DetectedByClass(const std::vector<ObjectRow>& objects) {
  std::map<std::string, Points2d> places;
  for (const ObjectRow& row : objects) {
    if (row.center_in_world) places[row.class_name].push_back(row.center_in_world->head<2>());
  }
  std::vector<PlotSeries> series;
  for (auto& [name, points] : places) {
    series.push_back(
        {name + ", detected", PlotStyle::kPoints, std::move(points), {}, ColorOf(name)});
  }
  return series;
}

Plot MapPlot(const std::vector<TrueSighting>& sightings,
             const std::vector<ObjectComparison>& comparisons, const ObjectRows& rows,
             const std::vector<MapRow>& map) {
  constexpr const char* kBlack = "#000000";
  constexpr const char* kGray = "#b0b0b0";
  const std::set<int> wanted = WantedObjects(comparisons);
  PlotPanel panel{"x (east), m", "y (north), m", {}, /*equal_axes=*/true};
  const auto circles = [&](bool is_wanted, const char* label, const char* color) {
    return PlotSeries{
        label, PlotStyle::kCircles, Positions(sightings, wanted, is_wanted), {}, color};
  };
  panel.series = {circles(true, "true, when in view", kBlack),
                  circles(false, "true, only passed", kGray),
                  {"in the map", PlotStyle::kCrosses, Positions(map), {}, kBlack}};
  std::ranges::move(DetectedByClass(rows.objects), std::back_inserter(panel.series));
  return {"map", "Objects, seen from above", {panel}};
}

}  // namespace

ComparedHunt CompareHuntOutput(const std::string& recording, const std::string& output) {
  const FlightTruth flight(recording);
  ObjectTruth truth = ReadObjectTruth(flight.root());
  const std::string file = (fs::path(output) / "object_detections.csv").string();
  ObjectRows rows = ParseObjectRows(ReadFile(file), file);
  if (rows.frames.empty()) throw InputError(file + ": no rows, expected some for every image");
  auto comparisons = CompareObjects(flight, truth.objects, truth.sightings, rows, file);
  return {std::move(truth), std::move(rows), std::move(comparisons)};
}

Report EvaluateHunt(const std::string& recording, const std::string& output) {
  const auto [truth, rows, comparisons] = CompareHuntOutput(recording, output);
  const auto& [objects, sightings] = truth;

  Report report;
  report.title = fmt::format("Hunt: {}", fs::path(recording).lexically_normal().string());
  report.tables = {DetectionTable(comparisons), ConfusionTable(comparisons),
                   ProbabilityTable(comparisons)};
  std::vector<MapRow> map;
  const std::string map_file = (fs::path(output) / "object_map.csv").string();
  if (fs::exists(map_file)) {
    map = ParseMapRows(ReadFile(map_file), map_file);
    report.tables.push_back(MapTable(CompareMap(objects, sightings, comparisons, map)));
  }
  report.plots = {MapPlot(sightings, comparisons, rows, map)};
  return report;
}

}  // namespace kestrel
