// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/hunt_replay.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/console/replay/replay_options.h"
#include "kestrel/app/evaluation/hunt_result.h"
#include "kestrel/app/evaluation/object_comparison.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/flight/session/hunt_task.h"
#include "kestrel/io/recording/tables/csv_columns.h"
#include "kestrel/io/recording/tables/csv_table.h"
#include "kestrel/io/recording/tables/object_csv.h"
#include "kestrel/io/recording/tables/object_map_csv.h"

namespace kestrel {
namespace {

constexpr char kTrueObjects[] = "objects0/data.csv";

using Comparisons = std::vector<ObjectComparison>;

// Counts for one frame.
struct Tally {
  int wanted = 0, found = 0;  // the wanted objects
  int of_objects = 0;         // detections of an existing object
  int not_right = 0;          // detections of nothing, or with the wrong class
  std::optional<double> worst_px;

  void Add(const ObjectComparison& comparison) {
    wanted += comparison.is_wanted;
    found += comparison.is_wanted && comparison.IsDetected();
    if (!comparison.IsDetected()) return;
    of_objects += comparison.IsObject();
    not_right += comparison.true_class != comparison.detected_class;
    if (!comparison.IsObject()) return;
    worst_px = std::max(worst_px.value_or(0), comparison.center_error_px);
  }
  FrameMark Mark() const {
    if (not_right > 0) return FrameMark::kFalse;
    if (found < wanted) return FrameMark::kLost;
    return of_objects > 0 ? FrameMark::kFound : FrameMark::kNothing;
  }
};

// Adds the objects that can be found to the frame, and those that were not found.
void AddTruth(const Comparisons& comparisons, const std::vector<TrueSighting>& sightings,
              ReplayFrame* frame) {
  Tally tally;
  for (const ObjectComparison& comparison : comparisons) {
    tally.Add(comparison);
    if (!comparison.IsObject()) continue;
    const TrueSighting& truth = *NearestSighting(sightings, *comparison.true_id, frame->time);
    const Eigen::Vector2f center = truth.center_px.cast<float>();
    const bool is_lost = comparison.is_wanted && !comparison.IsDetected();
    frame->shapes.push_back({OverlayLayer::kTruth,
                             {{center.x(), center.y()}},
                             is_lost ? "lost: " + comparison.true_class : ""});
  }
  frame->mark = tally.Mark();
  frame->error_px = tally.worst_px;
  frame->facts.push_back({"found", fmt::format("{} of {}", tally.found, tally.wanted)});
  frame->facts.push_back({"false", std::to_string(tally.not_right)});
  frame->facts.push_back(
      {"largest centre error", tally.worst_px ? fmt::format("{:.2f} px", *tally.worst_px) : ""});
}

void MarkByObjects(const std::string& recording, ReplayResult* result) {
  const FlightTruth flight(recording);
  const auto [objects, sightings] = ReadObjectTruth(flight.root());
  const std::string name = kObjectTable;
  std::map<Time, Comparisons> by_frame;
  for (ObjectComparison& comparison :
       CompareObjects(flight, objects, sightings, ParseObjectRows(result->table, name), name)) {
    by_frame[comparison.time].push_back(std::move(comparison));
  }
  for (ReplayFrame& frame : result->frames) AddTruth(by_frame[frame.time], sightings, &frame);
}

// The map beside the table of an earlier run, if there is one.
std::vector<MapEntry> EarlierMap(const std::string& table) {
  const auto map = std::filesystem::path(table).parent_path() / "object_map.csv";
  if (!std::filesystem::exists(map)) return {};
  return StandingObjects(ReadFile(map.string()), map.string());
}

class ObjectSearch : public ReplaySearch {
 public:
  ObjectSearch(const std::vector<std::string>& sources, const HuntPipelineOptions& options,
               const ObjectModel& model, std::optional<double> altitude_m)
      : options_(options),
        model_(model),
        altitude_m_(altitude_m),
        truth_(FindTruth(sources, kTrueObjects)) {}

  PixelFormat format() const override { return PixelFormat::kBgr; }

  ReplaySubject Subject() const override {
    return {HuntSeries(), HuntLayers(), HuntImageViews({model_, options_.detector}),
            ReplayOptions(options_), truth_.has_value()};
  }

  StartRun Detect(const std::vector<std::string>& settings) const override {
    return [this,
            task = HuntTask(WithSettings(options_, settings), model_)](const OpenedSource& opened) {
      auto session = MakeSession(opened, task, {.altitude_m = altitude_m_});
      const auto map = [this, objects = session->vision().map()] {
        return StandingObjects(ObjectMapCsv(objects->Confirmed(), model_), "map");
      };
      return ReplayRun(std::move(session), HuntView{model_}, /*table=*/"", Completion(map));
    };
  }

  StartRun Show(const std::string& table) const override {
    return [this, table](const OpenedSource& opened) {
      auto earlier = std::make_unique<EarlierResults<HuntResult>>(table, opened, options_);
      const HuntResult& result = earlier->result();
      const HuntView view{result.model()};
      const std::string text = result.text();
      return ReplayRun(MakeSession(opened, std::move(earlier)), view, text,
                       Completion([table] { return EarlierMap(table); }));
    };
  }

 private:
  // 'make_map': called after the last frame.
  ReplayFrames::Complete Completion(std::function<std::vector<MapEntry>()> make_map) const {
    return [truth = truth_, make_map = std::move(make_map)](ReplayResult* result) {
      if (truth) MarkByObjects(*truth, result);
      result->map = make_map();
    };
  }

  HuntPipelineOptions options_;
  ObjectModel model_;
  std::optional<double> altitude_m_;
  std::optional<std::string> truth_;  // the recording that has the truth
};

}  // namespace

std::unique_ptr<ReplaySearch> SearchForObjects(const std::vector<std::string>& sources,
                                               const HuntPipelineOptions& options,
                                               const ObjectModel& model,
                                               std::optional<double> altitude_m) {
  return std::make_unique<ObjectSearch>(sources, options, model, altitude_m);
}

std::vector<MapEntry> StandingObjects(const std::string& map_csv, const std::string& file) {
  const CsvTable cells(map_csv, file);
  const std::size_t class_name = cells.Column("class"), moving = cells.Column("moving"),
                    sigma = cells.Column("sigma_m"), first_seen = cells.Column("first_seen_ns");
  const VectorColumns position(cells, "p_", "_m");
  std::vector<MapEntry> entries;
  for (std::size_t row = 0; row < cells.row_count(); ++row) {
    if (cells.Integer(row, moving) != 0) continue;
    const double variance = std::pow(cells.Number(row, sigma), 2);
    entries.push_back({TimeFromNanoseconds(cells.Integer(row, first_seen)),
                       {.label = std::string(cells.Text(row, class_name)),
                        .color = "",
                        .position = position.Parse(row).head<2>(),
                        .covariance = variance * Eigen::Matrix2d::Identity()}});
  }
  return entries;
}

}  // namespace kestrel
