// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/object_tables.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "kestrel/app/evaluation/bins.h"
#include "kestrel/app/evaluation/statistics.h"

namespace kestrel {
namespace {

double Share(int part, int whole) {
  return whole == 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(part) / whole;
}

struct DetectionTally {
  int wanted = 0, wanted_found = 0;
  int detections = 0, of_an_object = 0;
  int right_class = 0, right_shape = 0;
  std::vector<double> center_errors_px, depth_errors, world_errors_m;

  void Add(const ObjectComparison& c) {
    wanted += c.is_wanted;
    wanted_found += c.is_wanted && c.IsDetected();
    detections += c.IsDetected();
    if (!c.IsObject() || !c.IsDetected()) return;
    ++of_an_object;
    right_class += c.true_class == c.detected_class;
    right_shape += c.true_shape == c.detected_shape;
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
            FormatPercent(Share(right_shape, of_an_object)),
            FormatFixed(Median(center_errors_px), 2),
            FormatFixed(Quantile(center_errors_px, 0.95), 2),
            FormatFixed(Median(depth_errors), 2),
            FormatFixed(Median(world_errors_m), 3),
            FormatFixed(Quantile(world_errors_m, 0.95), 3)};
  }
};

// The class in whose row a comparison counts: the true one or, without one, the detected one.
const std::string& ListedClass(const ObjectComparison& c) {
  return c.IsObject() ? c.true_class : c.detected_class;
}

}  // namespace

ReportTable DetectionTable(std::span<const ObjectComparison> comparisons) {
  ReportTable table{
      "objects",
      "Detection of objects",
      "Wanted: sightings wholly in view with at least 50 px. False: detections of "
      "nothing that is there, under the class they were given.",
      {"class", "wanted", "found", "recall, %", "95 % interval, %", "detections", "false",
       "precision, %", "class right, %", "shape right, %", "centre median, px", "95 %, px",
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

ReportTable ProbabilityTable(std::span<const ObjectComparison> comparisons) {
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  constexpr std::array<Bin, 6> kBins{
      {{0, 0.5}, {0.5, 0.7}, {0.7, 0.9}, {0.9, 0.99}, {0.99, 0.999}, {0.999, kOpen}}};
  struct Tally {
    std::vector<double> reported;
    int right = 0;
  };
  std::array<Tally, kBins.size()> classes, digits;
  const auto add = [&](double probability, bool is_right,
                       std::array<Tally, kBins.size()>* tallies) {
    for (std::size_t i = 0; i < kBins.size(); ++i) {
      if (!kBins[i].Contains(probability)) continue;
      (*tallies)[i].reported.push_back(probability);
      (*tallies)[i].right += is_right;
    }
  };
  for (const ObjectComparison& c : comparisons) {
    if (!c.IsDetected()) continue;
    add(c.class_probability, c.true_class == c.detected_class && c.true_shape == c.detected_shape,
        &classes);
    if (c.digit && c.true_digit) {
      add(c.digit->probability, c.digit->digit == *c.true_digit, &digits);
    }
  }
  ReportTable table{"probabilities",
                    "What is said and what is right",
                    "",
                    {"of", "said", "count", "said, mean, %", "right, %", "95 % interval, %"},
                    {}};
  for (const auto& [name, tallies] : {std::pair("class", &classes), std::pair("digit", &digits)}) {
    for (std::size_t i = 0; i < kBins.size(); ++i) {
      const auto& [reported, right] = (*tallies)[i];
      if (reported.empty()) continue;
      const int count = static_cast<int>(reported.size());
      table.rows.push_back({name, kBins[i].Label(), std::to_string(count),
                            FormatPercent(Mean(reported)), FormatPercent(Share(right, count)),
                            FormatPercent(WilsonInterval(right, count))});
    }
  }
  return table;
}

ReportTable MapTable(std::span<const MapComparison> comparisons) {
  int objects = 0, found = 0, entries = 0, right_class = 0, right_shape = 0;
  int digits = 0, right_digits = 0;
  std::vector<double> position_errors_m, velocity_errors_mps;
  for (const MapComparison& c : comparisons) {
    objects += c.IsObject();
    entries += c.IsMapped();
    if (!c.IsObject() || !c.IsMapped()) continue;
    ++found;
    right_class += c.true_class == c.mapped_class;
    right_shape += c.is_shape_right;
    digits += c.is_digit_right.has_value();
    right_digits += c.is_digit_right.value_or(false);
    position_errors_m.push_back(c.position_error_m);
    velocity_errors_mps.push_back(c.velocity_error_mps);
  }
  return {
      "map",
      "Map after the last frame",
      "Objects: those with three wanted sightings, and others that are in the map. An entry is an "
      "object's when it is within 1 m of it. Digits: 6 and 9 as one.",
      {"objects", "in the map", "complete, %", "entries", "false", "precision, %", "class right, %",
       "shape right, %", "digits", "right", "position mean, m", "position max, m",
       "velocity max, m/s"},
      {{std::to_string(objects), std::to_string(found), FormatPercent(Share(found, objects)),
        std::to_string(entries), std::to_string(entries - found),
        FormatPercent(Share(found, entries)), FormatPercent(Share(right_class, found)),
        FormatPercent(Share(right_shape, found)), std::to_string(digits),
        std::to_string(right_digits), FormatFixed(Mean(position_errors_m), 3),
        FormatFixed(Quantile(position_errors_m, 1), 3),
        FormatFixed(Quantile(velocity_errors_mps, 1), 3)}}};
}

}  // namespace kestrel
