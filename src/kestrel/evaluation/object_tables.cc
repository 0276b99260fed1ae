// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/evaluation/object_tables.h"

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "kestrel/evaluation/statistics.h"

namespace kestrel {
namespace {

double Share(int part, int whole) {
  return whole == 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(part) / whole;
}

struct DetectionTally {
  int wanted = 0, wanted_found = 0;
  int detections = 0, of_an_object = 0;
  int right_class = 0;
  std::vector<double> center_errors_px, depth_errors, world_errors_m;

  void Add(const ObjectComparison& c) {
    wanted += c.is_wanted;
    wanted_found += c.is_wanted && c.IsDetected();
    detections += c.IsDetected();
    if (!c.IsObject() || !c.IsDetected()) return;
    ++of_an_object;
    right_class += c.true_class == c.detected_class;
    center_errors_px.push_back(c.center_error_px);
    if (c.depth_error) depth_errors.push_back(100 * std::abs(*c.depth_error));
    if (c.world_error_m) world_errors_m.push_back(*c.world_error_m);
  }
  std::vector<std::string> Row(const std::string& name) const {
    return {name,
            std::to_string(wanted),
            std::to_string(wanted_found),
            FormatPercent(Share(wanted_found, wanted)),
            FormatPercent(WilsonInterval(wanted_found, wanted)),
            std::to_string(detections),
            std::to_string(detections - of_an_object),
            FormatPercent(Share(of_an_object, detections)),
            FormatPercent(Share(right_class, of_an_object)),
            FormatFixed(Median(center_errors_px), 2),
            FormatFixed(Quantile(center_errors_px, 0.95), 2),
            FormatFixed(Median(depth_errors), 2),
            FormatFixed(Median(world_errors_m), 3),
            FormatFixed(Quantile(world_errors_m, 0.95), 3)};
  }
};

// The class that a comparison is listed under: the true one, or else the detected.
const std::string& ListedClass(const ObjectComparison& c) {
  return c.IsObject() ? c.true_class : c.detected_class;
}

}  // namespace

ReportTable DetectionTable(std::span<const ObjectComparison> comparisons) {
  ReportTable table{"objects",
                    "Detection of objects",
                    "Wanted: sightings wholly in view with at least 50 px. False: detections of "
                    "nothing that is there, under the class they were given.",
                    {"class", "wanted", "found", "recall, %", "95 % interval, %", "detections",
                     "false", "precision, %", "class right, %", "centre median, px", "95 %, px",
                     "depth median, %", "world median, m", "95 %, m"},
                    {}};
  std::map<std::string, DetectionTally> by_class;
  DetectionTally all;
  for (const ObjectComparison& comparison : comparisons) {
    by_class[ListedClass(comparison)].Add(comparison);
    all.Add(comparison);
  }
  for (const auto& [name, tally] : by_class) table.rows.push_back(tally.Row(name));
  table.rows.push_back(all.Row("all"));
  return table;
}

ReportTable ConfusionTable(std::span<const ObjectComparison> comparisons) {
  std::set<std::string> true_classes, detected_classes;
  std::map<std::pair<std::string, std::string>, int> counts;
  for (const ObjectComparison& c : comparisons) {
    if (!c.IsObject() || !c.IsDetected()) continue;
    true_classes.insert(c.true_class);
    detected_classes.insert(c.detected_class);
    ++counts[{c.true_class, c.detected_class}];
  }
  ReportTable table{"confusion", "Classes: true (rows) and detected", "", {"true class"}, {}};
  table.columns.insert(table.columns.end(), detected_classes.begin(), detected_classes.end());
  for (const std::string& true_class : true_classes) {
    table.rows.push_back({true_class});
    for (const std::string& detected_class : detected_classes) {
      table.rows.back().push_back(std::to_string(counts[{true_class, detected_class}]));
    }
  }
  return table;
}

ReportTable MapTable(std::span<const MapComparison> comparisons) {
  int objects = 0, found = 0, entries = 0, right_class = 0;
  std::vector<double> position_errors_m, velocity_errors_mps;
  for (const MapComparison& c : comparisons) {
    objects += c.IsObject();
    entries += c.IsMapped();
    if (!c.IsObject() || !c.IsMapped()) continue;
    ++found;
    right_class += c.true_class == c.mapped_class;
    position_errors_m.push_back(c.position_error_m);
    velocity_errors_mps.push_back(c.velocity_error_mps);
  }
  return {
      "map",
      "Map after the last frame",
      "Objects: those with three wanted sightings, and others that are in the map. An entry is an "
      "object's when it is within 1 m of it.",
      {"objects", "in the map", "complete, %", "entries", "false", "precision, %", "class right, %",
       "position mean, m", "position max, m", "velocity max, m/s"},
      {{std::to_string(objects), std::to_string(found), FormatPercent(Share(found, objects)),
        std::to_string(entries), std::to_string(entries - found),
        FormatPercent(Share(found, entries)), FormatPercent(Share(right_class, found)),
        FormatFixed(Mean(position_errors_m), 3), FormatFixed(Quantile(position_errors_m, 1), 3),
        FormatFixed(Quantile(velocity_errors_mps, 1), 3)}}};
}

}  // namespace kestrel
