// SPDX-License-Identifier: BSD-3-Clause
// Prints what each step of the search for the landing pattern earns: what is found, found wrongly
// and how long a frame takes without the step, without a pass and without a method, as a Markdown
// table.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "kestrel/vision/landing/search/search_plan.h"
#include "landing_frames.h"
#include "landing_score.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr std::uint64_t kSeed = 60'000'000;

struct Options {
  std::string data_dir = KESTREL_DATA_DIR;
  int stills = 60;  // of each light
  int lookalikes = 300;
  std::vector<int> skip;  // steps from 1, left out in every row
};

std::uint32_t SkippedAlways(const std::vector<int>& steps) {
  std::uint32_t bits = 0;
  for (const int step : steps) bits |= 1U << (step - 1);
  return bits;
}

const char* ToString(SearchMethod method) {
  switch (method) {
    case SearchMethod::kAreas:
      return "areas";
    case SearchMethod::kCutAreas:
      return "cut areas";
    case SearchMethod::kArcs:
      return "arcs";
    case SearchMethod::kCross:
      return "cross";
  }
  return "";
}

// Part of the search that is left out: its name, and the bits of its steps.
using Skipped = std::pair<std::string, std::uint32_t>;

std::vector<Skipped> AllSkipped() {
  std::vector<Skipped> all = {{"nothing", 0}};
  for (std::size_t i = 0; i < kSearchSteps; ++i) {
    all.emplace_back(
        fmt::format("step {}: pass {}, {}", i + 1, kSteps[i].pass + 1, ToString(kSteps[i].method)),
        1U << i);
  }
  const auto add = [&](const std::string& name, const auto& is_part) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < kSearchSteps; ++i) {
      if (is_part(kSteps[i])) bits |= 1U << i;
    }
    all.emplace_back(name, bits);
  };
  for (std::size_t pass = 0; pass < kSearchPasses; ++pass) {
    add(fmt::format("pass {}", pass + 1), [&](const SearchStep& s) { return s.pass == pass; });
  }
  for (const SearchMethod method :
       {SearchMethod::kAreas, SearchMethod::kCutAreas, SearchMethod::kArcs, SearchMethod::kCross}) {
    add(ToString(method), [&](const SearchStep& s) { return s.method == method; });
  }
  return all;
}

// Stills in each light from these heights.
LandingFrameSet MakeStills(int per_light, double min_altitude_m, double max_altitude_m) {
  LandingFrameSet set{"own", PaperCamera(), {}};
  for (int light = 0; light < kStillConditions; ++light) {
    LandingStillOptions options;
    options.condition = static_cast<StillCondition>(light);
    options.min_altitude_m = min_altitude_m;
    options.max_altitude_m = max_altitude_m;
    options.min_visible_fraction = 0.25;
    const LandingStillMaker maker(options);
    for (int i = 0; i < per_light; ++i) {
      set.frames.push_back(FrameFromStill(maker, ToString(options.condition), kSeed + i));
    }
  }
  return set;
}

LandingFrameSet MakeLookalikes(int count) {
  LandingFrameSet set{"look-alikes", PaperCamera(), {}};
  LandingStillOptions options;
  options.min_altitude_m = 0.4;
  options.max_altitude_m = 14;
  options.lookalikes = LookalikeSet::kWithCounterfeits;
  const LandingStillMaker maker(options);
  for (int i = 0; i < count; ++i) {
    set.frames.push_back(FrameFromLookalikes(maker, "look-alikes", kSeed + i));
  }
  return set;
}

struct Result {
  LandingTally tally;
  double ms = 0;  // of one frame, processor time
};

Result Score(const std::vector<LandingFrameSet>& sets, std::uint32_t skipped) {
  Result result;
  int frames = 0;
  const std::clock_t start = std::clock();
  for (const LandingFrameSet& set : sets) {
    LandingPatternDetectorOptions options;
    options.skipped_steps = skipped;
    const LandingPatternDetector detector(CameraModel(set.camera), options);
    const auto scores =
        ScoreFrames(detector, set.frames.size(), 1, NoHint,
                    [&](std::size_t i) -> const LandingFrame& { return set.frames[i]; });
    for (const LandingScore& score : scores) result.tally.Add(score);
    frames += static_cast<int>(set.frames.size());
  }
  result.ms =
      1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / std::max(frames, 1);
  return result;
}

int Found(const LandingTally& tally) { return tally.found + tally.partial_right; }
int False(const LandingTally& tally) {
  return tally.wrong + tally.false_detections + tally.partial_found - tally.partial_right;
}

int Report(const Options& options) {
  const std::vector<LandingFrameSet> real = ReadLandingReal(options.data_dir);
  const std::vector<LandingFrameSet> hard = ReadLandingHard(options.data_dir);
  const std::vector<LandingFrameSet> near = {MakeStills(options.stills, 0.35, 2)};
  const std::vector<LandingFrameSet> far = {MakeStills(options.stills, 2, 14)};
  const std::vector<LandingFrameSet> none = {MakeLookalikes(options.lookalikes)};
  if (real.empty() || hard.empty()) {
    fmt::print("skipped: landing_real and landing_hard are not both in {}\n\n", options.data_dir);
  }
  fmt::print(
      "| without | real: found | hard: found | own below 2 m | own above | false, all | a real "
      "frame, ms | one without the pattern, ms |\n|---|---|---|---|---|---|---|---|\n");
  for (const auto& [name, bits] : AllSkipped()) {
    const std::uint32_t skipped = bits | SkippedAlways(options.skip);
    const Result by_real = Score(real, skipped), by_hard = Score(hard, skipped);
    const Result by_near = Score(near, skipped), by_far = Score(far, skipped);
    const Result by_none = Score(none, skipped);
    int falsely = 0;
    for (const Result* result : {&by_real, &by_hard, &by_near, &by_far, &by_none}) {
      falsely += False(result->tally);
    }
    fmt::print("| {} | {} | {} | {} | {} | {} | {:.2f} | {:.2f} |\n", name, Found(by_real.tally),
               Found(by_hard.tally), Found(by_near.tally), Found(by_far.tally), falsely, by_real.ms,
               by_none.ms);
    std::fflush(stdout);
  }
  return 0;
}

int Run(int argc, char** argv) {
  Options options;
  CLI::App app("What each step of the search for the landing pattern earns");
  app.add_option("--data", options.data_dir, "folder with landing_real and landing_hard");
  app.add_option("--stills", options.stills, "own stills of each light");
  app.add_option("--lookalikes", options.lookalikes, "own pictures without the pattern");
  app.add_option("--skip", options.skip, "steps that are left out in every row")
      ->delimiter(',')
      ->check(CLI::Range(1, static_cast<int>(kSearchSteps)));
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  return Report(options);
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  return kestrel::ReportMain([&] { return kestrel::Run(argc, argv); });
}
