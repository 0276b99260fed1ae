// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/hunt_replay.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/cli/ground_warning.h"
#include "kestrel/app/cli/hunt_result.h"
#include "kestrel/app/console/replay_options.h"
#include "kestrel/app/evaluation/object_comparison.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/io/recording/object_csv.h"
#include "kestrel/io/recording/object_map_csv.h"
#include "kestrel/vision/pipeline/camera_poses.h"

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
  const std::string name = "object_detections.csv";
  std::map<Time, Comparisons> by_frame;
  for (ObjectComparison& comparison :
       CompareObjects(flight, objects, sightings, ParseObjectRows(result->table, name), name)) {
    by_frame[comparison.time].push_back(std::move(comparison));
  }
  for (ReplayFrame& frame : result->frames) AddTruth(by_frame[frame.time], sightings, &frame);
}

// The part of a frame that both kinds of runs keep.
class HuntReplayRun : public ReplayRun {
 public:
  std::string Found() const override { return fmt::format("{} detections", detections_); }

 protected:
  explicit HuntReplayRun(std::optional<std::string> truth) : truth_(std::move(truth)) {}

  void Keep(const HuntView& view, const HuntObservation& observation, ReplayResult* result) {
    result->frames.push_back(ReplayFrameOf(view, observation));
    detections_ += observation.report.detections.size();
  }

  void Complete(ReplayResult* result) override {
    if (truth_) MarkByObjects(*truth_, result);
  }

 private:
  std::optional<std::string> truth_;  // the recording that has the truth
  std::size_t detections_ = 0;
};

class HuntPipelineRun : public HuntReplayRun {
 public:
  HuntPipelineRun(const OpenedSource& opened, const ObjectModel& model,
                  const HuntPipelineOptions& options, std::optional<double> altitude_m,
                  std::optional<std::string> truth)
      : HuntReplayRun(std::move(truth)),
        pipeline_(opened.calibration, model, options),
        view_{model},
        altitude_m_(altitude_m) {
    pipeline_.SetAltitude(altitude_m);
  }

  void AddPose(const PoseSample& pose) override { pipeline_.AddPose(pose); }

  // Time from the middle row to the last row of a rolling shutter.
  Duration after_frame() const override {
    return DurationFromSeconds(pipeline_.options().readout_s / 2);
  }

  std::string Warning() const override { return GroundWarning(pipeline_, altitude_m_, has_world_); }

 private:
  Duration Add(const Frame& frame, ReplayResult* result) override {
    const HuntObservation& observation = pipeline_.Process(frame.image, frame.time);
    if (result->table.empty()) result->table = ObjectCsvHeader();
    result->table += ObjectCsvRows(frame.name, observation, view_.model);
    Keep(view_, observation, result);
    has_world_ = observation.world_from_camera.has_value();
    return observation.detect_time;
  }

  void Complete(ReplayResult* result) override {
    HuntReplayRun::Complete(result);
    result->map = StandingObjects(ObjectMapCsv(pipeline_.map().Confirmed(), view_.model), "map");
  }

  HuntPipeline pipeline_;
  HuntView view_;
  std::optional<double> altitude_m_;
  bool has_world_ = false;  // the last frame had a pose
};

class HuntResultRun : public HuntReplayRun {
 public:
  HuntResultRun(const OpenedSource& opened, const HuntPipelineOptions& options,
                const std::string& table, std::optional<std::string> truth)
      : HuntReplayRun(std::move(truth)),
        table_(table),
        found_before_(table),
        view_{found_before_.model()},
        poses_(opened.calibration, static_cast<std::size_t>(options.pose_capacity),
               DurationFromSeconds(options.pose_gap_s), Duration::zero(), {}) {}

  void AddPose(const PoseSample& pose) override { poses_.Add(pose); }

 private:
  Duration Add(const Frame& frame, ReplayResult* result) override {
    const auto camera = poses_.At(frame.time);
    const HuntObservation observation = found_before_.Next(
        frame.time, camera ? std::optional(camera->world_from_camera) : std::nullopt);
    Keep(view_, observation, result);
    return observation.detect_time;
  }

  void Complete(ReplayResult* result) override {
    found_before_.RequireEnd();
    result->table = found_before_.text();
    HuntReplayRun::Complete(result);
    const auto map = std::filesystem::path(table_).parent_path() / "object_map.csv";
    if (std::filesystem::exists(map)) {
      result->map = StandingObjects(ReadFile(map.string()), map.string());
    }
  }

  std::string table_;
  HuntResult found_before_;
  HuntView view_;
  CameraPoses poses_;
};

class ObjectSearch : public ReplaySearch {
 public:
  ObjectSearch(const SourceArguments& source, const HuntPipelineOptions& options,
               const ObjectModel& model)
      : source_(source),
        options_(options),
        model_(model),
        truth_(FindTruth(source.sources, kTrueObjects)) {}

  PixelFormat format() const override { return PixelFormat::kBgr; }

  ReplaySubject Subject() const override {
    return {HuntSeries(), HuntLayers(), HuntImageViews({model_, options_.detector}),
            ReplayOptions(options_), truth_.has_value()};
  }

  StartRun Detect(const std::vector<std::string>& settings) const override {
    return [this, options = WithSettings(options_, settings)](const OpenedSource& opened) {
      return std::make_unique<HuntPipelineRun>(opened, model_, options, source_.altitude_m, truth_);
    };
  }

  StartRun Show(const std::string& table) const override {
    return [this, table](const OpenedSource& opened) {
      return std::make_unique<HuntResultRun>(opened, options_, table, truth_);
    };
  }

 private:
  const SourceArguments& source_;
  HuntPipelineOptions options_;
  ObjectModel model_;
  std::optional<std::string> truth_;  // the recording that has the truth
};

}  // namespace

std::unique_ptr<ReplaySearch> SearchForObjects(const SourceArguments& source,
                                               const HuntPipelineOptions& options,
                                               const ObjectModel& model) {
  return std::make_unique<ObjectSearch>(source, options, model);
}

}  // namespace kestrel
