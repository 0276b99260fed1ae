// SPDX-License-Identifier: BSD-3-Clause
// Prints how well the landing pattern is found when the detector gets wrong information
// (calibration, altitude, attitude, track) and when the print is not flat, beside the right case.
#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "landing_falsehoods.h"
#include "landing_frames.h"
#include "landing_score.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr int kThreads = 2;

struct Options {
  std::string data_dir = KESTREL_DATA_DIR;
  int stills = 100;
  bool verbose = false;
};

LandingTally Score(const LandingFrameSet& set, const CameraIntrinsics& camera, HintOf hint,
                   bool verbose) {
  const LandingPatternDetector detector{CameraModel(camera), {}};
  return LandingTally(ScoreFrames(
      detector, set.frames.size(), kThreads, hint, [&](std::size_t i) { return set.frames[i]; },
      [&](const LandingFrame& frame, const LandingScore& score) {
        if (!verbose || score.truth == PatternTruth::kUnknown ||
            score.outcome == LandingOutcome::kFound || score.outcome == LandingOutcome::kQuiet) {
          return;
        }
        fmt::print("- {}: {}; reached {}: {}; ring of {:.0f} px, {:.2f} m\n", score.name,
                   score.outcome == LandingOutcome::kMissed ? "missed" : "wrong",
                   ToString(score.reached), score.reason, 2 * frame.ring_radius_px,
                   frame.altitude_m);
      }));
}

LandingTally ScoreSets(const std::vector<LandingFrameSet>& sets, const CalibrationError& error,
                       bool verbose) {
  LandingTally tally;
  for (const LandingFrameSet& set : sets) {
    tally.Add(Score(set, error.apply(set.camera), NoHint, verbose));
  }
  return tally;
}

std::string FoundCells(const LandingTally& t) {
  return fmt::format("{} of {} | {}", t.found, t.frames, t.wrong + t.false_detections);
}

std::string StillCells(const LandingTally& t, const LandingTally& right) {
  return fmt::format("{} | {:.3f} | {:.2f} | {:.2f} | {:.2f} | {:.1f}", FoundCells(t),
                     static_cast<double>(t.found) / right.found, Quantile(t.center_errors_px, 0.5),
                     Quantile(t.center_errors_px, 0.95), 100 * Quantile(t.position_errors, 0.5),
                     Quantile(t.nees, 0.5));
}

constexpr const char* kStillHeader =
    "stills: found | wrong | of the first row's | centre error median, px | 95 %, px | position "
    "error median, % | NEES median";

void ReportCalibrations(const Options& options, const LandingFrameSet& stills) {
  const std::vector<LandingFrameSet> real = ReadLandingReal(options.data_dir);
  const std::vector<LandingFrameSet> hard = ReadLandingHard(options.data_dir);
  if (real.empty()) fmt::print("there is no {}/landing_real\n", options.data_dir);
  if (hard.empty()) fmt::print("there is no {}/landing_hard\n", options.data_dir);
  fmt::print(
      "## The calibration is wrong\n\n| calibration | real: found | false | stills of another "
      "renderer: found | false | {} |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      kStillHeader);
  LandingTally right;
  for (const CalibrationError& error : CalibrationErrors()) {
    const LandingTally of_stills =
        Score(stills, error.apply(stills.camera), NoHint, options.verbose);
    if (right.frames == 0) right = of_stills;
    fmt::print("| {} | {} | {} | {} |\n", error.name,
               FoundCells(ScoreSets(real, error, options.verbose)),
               FoundCells(ScoreSets(hard, error, options.verbose)), StillCells(of_stills, right));
    std::fflush(stdout);
  }
}

void ReportHints(const Options& options, const LandingFrameSet& stills) {
  fmt::print("\n## What is told is wrong\n\n| told | {} |\n|---|---|---|---|---|---|---|---|\n",
             kStillHeader);
  LandingTally right;
  for (const GivenHint& given : GivenHints()) {
    const LandingTally tally = Score(stills, stills.camera, given.make, options.verbose);
    if (right.frames == 0) right = tally;
    fmt::print("| {} | {} |\n", given.name, StillCells(tally, right));
    std::fflush(stdout);
  }
}

void ReportPrints(const Options& options, const LandingFrameSet& flat) {
  fmt::print("\n## The print is not flat\n\n| print | {} |\n|---|---|---|---|---|---|---|---|\n",
             kStillHeader);
  LandingTally right;
  for (const PrintError& print : PrintErrors()) {
    const bool is_flat = right.frames == 0;
    const LandingFrameSet stills = is_flat ? flat : RenderStills(options.stills, print, kThreads);
    const LandingTally tally = Score(stills, stills.camera, NoHint, options.verbose);
    if (is_flat) right = tally;
    fmt::print("| {} | {} |\n", print.name, StillCells(tally, right));
    std::fflush(stdout);
  }
}

int Run(int argc, char** argv) {
  Options options;
  CLI::App app{"The landing pattern detector when what it is told is wrong"};
  app.add_option("--data", options.data_dir, "folder with landing_real and landing_hard");
  app.add_option("--stills", options.stills, "rendered stills per altitude")
      ->check(CLI::PositiveNumber);
  app.add_flag("--verbose", options.verbose, "list what was missed or wrong, and why");
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  const LandingFrameSet stills = RenderStills(options.stills, PrintErrors().front(), kThreads);
  ReportCalibrations(options, stills);
  ReportHints(options, stills);
  ReportPrints(options, stills);
  return 0;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  return kestrel::ReportMain([&] { return kestrel::Run(argc, argv); });
}
