// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/landing_replay.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/console/replay/replay_options.h"
#include "kestrel/app/evaluation/land_result.h"
#include "kestrel/app/evaluation/landing_comparison.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/flight/session/land_task.h"
#include "kestrel/io/recording/tables/landing_csv.h"

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
  const std::string name = kLandingTable;
  const auto comparisons = CompareLanding(flight, ParseTruePatterns(ReadFile(file), file),
                                          ParseDetectionRows(result->table, name), name);
  for (std::size_t i = 0; i < comparisons.size(); ++i) AddTruth(comparisons[i], &result->frames[i]);
}

class PatternSearch : public ReplaySearch {
 public:
  PatternSearch(const std::vector<std::string>& sources, const LandingPipelineOptions& options,
                std::optional<double> altitude_m)
      : options_(options), altitude_m_(altitude_m), truth_(FindTruth(sources, kTruePatterns)) {}

  PixelFormat format() const override { return PixelFormat::kGray; }

  ReplaySubject Subject() const override {
    return {LandingSeries(), LandingLayers(), LandingImageViews(), ReplayOptions(options_),
            truth_.has_value()};
  }

  StartRun Detect(const std::vector<std::string>& settings) const override {
    return [this, task = LandTask(WithSettings(options_, settings))](const OpenedSource& opened) {
      return ReplayRun(MakeSession(opened, task, {.altitude_m = altitude_m_}),
                       ViewOf(opened.calibration, task.options()), /*table=*/"", Completion());
    };
  }

  StartRun Show(const std::string& table) const override {
    return [this, table](const OpenedSource& opened) {
      auto earlier = std::make_unique<EarlierResults<LandResult>>(table, opened, options_);
      const std::string text = earlier->result().text();
      return ReplayRun(MakeSession(opened, std::move(earlier)),
                       ViewOf(opened.calibration, options_), text, Completion());
    };
  }

 private:
  ReplayFrames::Complete Completion() const {
    return [truth = truth_](ReplayResult* result) {
      if (truth) return MarkByPatterns(*truth, result);
      MarkLost(&result->frames);
    };
  }

  LandingPipelineOptions options_;
  std::optional<double> altitude_m_;
  std::optional<std::string> truth_;  // the recording that has the truth
};

}  // namespace

std::unique_ptr<ReplaySearch> SearchForPattern(const std::vector<std::string>& sources,
                                               const LandingPipelineOptions& options,
                                               std::optional<double> altitude_m) {
  return std::make_unique<PatternSearch>(sources, options, altitude_m);
}

}  // namespace kestrel
