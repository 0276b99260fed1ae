// SPDX-License-Identifier: BSD-3-Clause
// Prints what each step of the search for the landing pattern earns: what is found, found wrongly
// and how long a frame takes without the step, without a pass and without a method, as a Markdown
// table.
#include <algorithm>
#include <bit>
#include <cstdio>
#include <ctime>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "kestrel/vision/landing/landing_search.h"
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
  bool is_eliminating = false;
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

// Stills in each light, or in one.
LandingFrameSet MakeStills(int per_light, LandingStillOptions options, bool each_light = true) {
  LandingFrameSet set{"own", options.camera, {}};
  for (int light = 0; light < (each_light ? kStillConditions : 1); ++light) {
    if (each_light) options.condition = static_cast<StillCondition>(light);
    const LandingStillMaker maker(options);
    for (int i = 0; i < per_light; ++i) {
      set.frames.push_back(FrameFromStill(maker, ToString(options.condition), kSeed + i));
    }
  }
  return set;
}

LandingStillOptions StillsFrom(double min_altitude_m, double max_altitude_m,
                               double max_visible_fraction = 1) {
  LandingStillOptions options;
  options.min_altitude_m = min_altitude_m;
  options.max_altitude_m = max_altitude_m;
  options.min_visible_fraction = 0.25;
  options.max_visible_fraction = max_visible_fraction;
  return options;
}

// A lens of 90 degrees, which shows no ring in the last decimetres.
LandingStillOptions NarrowLensStills() {
  LandingStillOptions options = StillsFrom(0.2, 0.8);
  options.camera = {.width_px = 640,
                    .height_px = 480,
                    .fx_px = 320,
                    .fy_px = 320,
                    .cx_px = 319.5,
                    .cy_px = 239.5,
                    .distortion_model = DistortionModel::kNone,
                    .distortion = {}};
  options.max_tilt_deg = 20;
  options.min_visible_fraction = 0.15;
  return options;
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
    LandingModels models(CameraModel(set.camera), {});
    models.skipped_steps = skipped;
    const auto buffers = std::make_unique<LandingWorkspace::Buffers>();
    for (const LandingFrame& frame : set.frames) {
      const TargetReport report = LandingSearch(models, frame.image, {}, buffers.get()).Run();
      result.tally.Add(ScoreLanding(frame, report, models.camera, models.options.pattern));
    }
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

// A column of the table.
struct Column {
  const char* name;
  std::vector<LandingFrameSet> sets;
  bool is_timed = false;
};

std::vector<Column> MakeColumns(const Options& options) {
  LandingStillOptions night = StillsFrom(0.3, 0.8);
  night.condition = StillCondition::kNight;
  return {{"real", ReadLandingReal(options.data_dir), true},
          {"hard", ReadLandingHard(options.data_dir)},
          {"own below 2 m", {MakeStills(options.stills, StillsFrom(0.35, 2))}},
          {"own above", {MakeStills(options.stills, StillsFrom(2, 14))}},
          {"cut off, below 1.2 m", {MakeStills(options.stills, StillsFrom(0.3, 1.2, 0.75))}},
          {"cut off, above 3 m", {MakeStills(options.stills, StillsFrom(3, 14, 0.85))}},
          {"night, below 0.8 m", {MakeStills(4 * options.stills, night, false)}},
          {"lens of 90 degrees, below 0.8 m", {MakeStills(options.stills, NarrowLensStills())}},
          {"none", {MakeLookalikes(options.lookalikes)}, true}};
}

// Prints a row of the table; returns what the steps earn: frames found, less five for each false
// one, less a tenth of the milliseconds of all columns.
double PrintRow(const std::vector<Column>& columns, const std::string& name, std::uint32_t skipped,
                std::FILE* file = stdout) {
  int found = 0, falsely = 0;
  double ms = 0;
  fmt::print(file, "| {} |", name);
  for (const Column& column : columns) {
    const Result result = Score(column.sets, skipped);
    found += Found(result.tally);
    falsely += False(result.tally);
    ms += result.ms;
    fmt::print(file, " {}", Found(result.tally));
    if (column.is_timed) fmt::print(file, "; {:.2f}", result.ms);
    fmt::print(file, " |");
  }
  fmt::print(file, " {} |\n", falsely);
  std::fflush(file);
  return found - 5 * falsely - 0.1 * ms;
}

// Leaves out one step after another, each time the one that earns least.
void Eliminate(const std::vector<Column>& columns, std::uint32_t skipped) {
  constexpr std::size_t kFewest = 4;  // steps that stay
  while (kSearchSteps - static_cast<std::size_t>(std::popcount(skipped)) > kFewest) {
    double best = -1e9;
    std::size_t least = 0;
    for (std::size_t i = 0; i < kSearchSteps; ++i) {
      if ((skipped >> i) & 1) continue;
      const double earned = PrintRow(columns, "", skipped | 1U << i, stderr);
      if (earned <= best) continue;
      best = earned;
      least = i;
    }
    skipped |= 1U << least;
    PrintRow(columns, fmt::format("and without step {}", least + 1), skipped);
  }
}

int Report(const Options& options) {
  const std::vector<Column> columns = MakeColumns(options);
  std::string head = "| without |", rule = "|---|";
  for (const Column& column : columns) {
    std::size_t frames = 0;
    for (const LandingFrameSet& set : column.sets) frames += set.frames.size();
    head += fmt::format(" {}, of {}{} |", column.name, frames,
                        column.is_timed ? "; ms of a frame" : "");
    rule += "---|";
  }
  fmt::print("{} false |\n{}---|\n", head, rule);
  const std::uint32_t always = SkippedAlways(options.skip);
  for (const auto& [name, bits] : AllSkipped()) PrintRow(columns, name, bits | always);
  if (options.is_eliminating) Eliminate(columns, always);
  return 0;
}

int Run(int argc, char** argv) {
  Options options;
  CLI::App app("What each step of the search for the landing pattern earns");
  app.add_option("--data", options.data_dir, "folder with landing_real and landing_hard");
  app.add_option("--stills", options.stills, "own stills of each light");
  app.add_option("--lookalikes", options.lookalikes, "own pictures without the pattern");
  app.add_flag("--eliminate", options.is_eliminating,
               "also leave out one step after another, the one that earns least");
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
