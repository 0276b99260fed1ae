// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/landing_replay.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/cli/land_result.h"
#include "kestrel/app/console/replay_options.h"
#include "kestrel/app/evaluation/landing_comparison.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/io/recording/landing_csv.h"
#include "kestrel/vision/pipeline/camera_poses.h"

namespace kestrel {
namespace {

constexpr char kTruePatterns[] = "landing_pattern0/data.csv";

FrameMark MarkOf(const LandingComparison& comparison) {
  switch (comparison.verdict) {
    case LandingVerdict::kFound:
      return FrameMark::kFound;
    case LandingVerdict::kFalse:
      return FrameMark::kFalse;
    case LandingVerdict::kMissed:
      return comparison.IsVisible() ? FrameMark::kLost : FrameMark::kNothing;
    case LandingVerdict::kQuiet:
      break;
  }
  return FrameMark::kNothing;
}

void AddTruth(const LandingComparison& comparison, ReplayFrame* frame) {
  frame->mark = MarkOf(comparison);
  if (comparison.errors) frame->error_px = comparison.errors->center_px;
  frame->facts.push_back(
      {"centre error", frame->error_px ? fmt::format("{:.2f} px", *frame->error_px) : ""});
  if (!comparison.IsVisible()) return;
  const Eigen::Vector2f center = comparison.truth->center_px.cast<float>();
  const bool is_lost = frame->mark == FrameMark::kLost;
  frame->shapes.push_back(
      {OverlayLayer::kTruth, {{center.x(), center.y()}}, is_lost ? "lost" : ""});
}

// Marks each frame by the table's row for it.
void MarkByPatterns(const std::string& recording, ReplayResult* result) {
  const FlightTruth flight(recording);
  const std::string file = (std::filesystem::path(flight.root()) / kTruePatterns).string();
  const std::string name = "landing_detections.csv";
  const auto comparisons = CompareLanding(flight, ParseTruePatterns(ReadFile(file), file),
                                          ParseDetectionRows(result->table, name), name);
  for (std::size_t i = 0; i < comparisons.size(); ++i) AddTruth(comparisons[i], &result->frames[i]);
}

// The part of a frame that both kinds of runs keep.
class LandingReplayRun : public ReplayRun {
 public:
  std::string Found() const override { return fmt::format("pattern found in {}", found_); }

 protected:
  LandingReplayRun(const OpenedSource& opened, const LandingPipelineOptions& options,
                   std::optional<std::string> truth)
      : view_(ViewOf(opened.calibration, options)), truth_(std::move(truth)) {}

  void Keep(const LandingObservation& observation, ReplayResult* result) {
    result->frames.push_back(ReplayFrameOf(view_, observation));
    found_ += observation.report.detection.has_value();
  }

  void Complete(ReplayResult* result) override {
    if (truth_) {
      MarkByPatterns(*truth_, result);
    } else {
      MarkLost(&result->frames);
    }
  }

 private:
  LandingView view_;
  std::optional<std::string> truth_;  // the recording that has the truth
  std::size_t found_ = 0;
};

class LandingPipelineRun : public LandingReplayRun {
 public:
  LandingPipelineRun(const OpenedSource& opened, const LandingPipelineOptions& options,
                     std::optional<double> altitude_m, std::optional<std::string> truth)
      : LandingReplayRun(opened, options, std::move(truth)),
        pipeline_(opened.calibration, options) {
    pipeline_.SetAltitude(altitude_m);
  }

  void AddPose(const PoseSample& pose) override { pipeline_.AddPose(pose); }

 private:
  Duration Add(const Frame& frame, ReplayResult* result) override {
    const LandingObservation& observation = pipeline_.Process(frame.image, frame.time);
    if (result->table.empty()) result->table = LandingCsvHeader();
    result->table += LandingCsvRow(frame.name, observation);
    Keep(observation, result);
    return observation.detect_time;
  }

  LandingPipeline pipeline_;
};

class LandingResultRun : public LandingReplayRun {
 public:
  LandingResultRun(const OpenedSource& opened, const LandingPipelineOptions& options,
                   const std::string& table, std::optional<std::string> truth)
      : LandingReplayRun(opened, options, std::move(truth)),
        found_before_(table),
        poses_(opened.calibration, static_cast<std::size_t>(options.pose_capacity),
               DurationFromSeconds(options.pose_gap_s), Duration::zero(), {}) {}

  void AddPose(const PoseSample& pose) override { poses_.Add(pose); }

 private:
  Duration Add(const Frame& frame, ReplayResult* result) override {
    const auto camera = poses_.At(frame.time);
    const LandingObservation observation = found_before_.Next(
        frame.time, camera ? std::optional(camera->world_from_camera) : std::nullopt);
    Keep(observation, result);
    return observation.detect_time;
  }

  void Complete(ReplayResult* result) override {
    found_before_.RequireEnd();
    result->table = found_before_.text();
    LandingReplayRun::Complete(result);
  }

  LandResult found_before_;
  CameraPoses poses_;
};

class PatternSearch : public ReplaySearch {
 public:
  PatternSearch(const SourceArguments& source, const LandingPipelineOptions& options)
      : source_(source), options_(options), truth_(FindTruth(source.sources, kTruePatterns)) {}

  PixelFormat format() const override { return PixelFormat::kGray; }

  ReplaySubject Subject() const override {
    return {LandingSeries(), LandingLayers(), LandingImageViews(), ReplayOptions(options_),
            truth_.has_value()};
  }

  StartRun Detect(const std::vector<std::string>& settings) const override {
    return [this, options = WithSettings(options_, settings)](const OpenedSource& opened) {
      return std::make_unique<LandingPipelineRun>(opened, options, source_.altitude_m, truth_);
    };
  }

  StartRun Show(const std::string& table) const override {
    return [this, table](const OpenedSource& opened) {
      return std::make_unique<LandingResultRun>(opened, options_, table, truth_);
    };
  }

 private:
  const SourceArguments& source_;
  LandingPipelineOptions options_;
  std::optional<std::string> truth_;  // the recording that has the truth
};

}  // namespace

std::unique_ptr<ReplaySearch> SearchForPattern(const SourceArguments& source,
                                               const LandingPipelineOptions& options) {
  return std::make_unique<PatternSearch>(source, options);
}

}  // namespace kestrel
