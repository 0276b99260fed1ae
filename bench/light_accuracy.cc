// SPDX-License-Identifier: BSD-3-Clause
// Prints how well the landing pattern is found in different light: under shadows of UAVs and of
// other things, in glare, darkness, dust and blur; what is detected falsely in the same light; and
// whether the qualities are the shares that are right.
#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "kestrel/core/codec/image_codec.h"
#include "kestrel/simulation/labelled_images/shadow_casters.h"
#include "landing_frames.h"
#include "landing_score.h"
#include "reliability.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr int kThreads = 2;
constexpr std::uint64_t kPatternSeed = 70'000'000, kLookalikeSeed = 80'000'000;
constexpr std::uint64_t kSeedsOfRow = 100'000;

struct Options {
  std::string data_dir = KESTREL_DATA_DIR;
  int stills = 200;
  int lookalikes = 3000;
  int counterfeits = 500;
  std::string row;  // rows whose name contains this
  bool verbose = false;
  std::string keep;  // folder for the images of misses and false detections
};

// The stills of a row of the table.
struct Row {
  std::string name;
  LandingStillOptions stills;
};

Row StillRow(StillCondition condition, std::span<const ShadowCaster> casters, int caster,
             double max_altitude_m, double min_visible) {
  Row row;
  row.name = caster < 0 ? ToString(condition) : fmt::format("shadow of a {}", casters[caster].name);
  row.stills.condition = condition;
  row.stills.shadow_caster = caster;
  row.stills.min_altitude_m = 0.4;
  row.stills.max_altitude_m = max_altitude_m;
  row.stills.min_visible_fraction = min_visible;
  return row;
}

// Stills of a print so near that the image shows it whole or in part, in darkness.
std::vector<Row> NightRows() {
  struct View {
    const char* name;
    double least, most;  // part of the print in view
    double lowest_m;
  };
  constexpr std::array<View, 3> kViews{{{"whole", 0.97, 1, 0.45},
                                        {"three quarters in view", 0.65, 0.85, 0.3},
                                        {"half in view", 0.4, 0.6, 0.3}}};
  std::vector<Row> rows;
  for (const View& view : kViews) {
    Row& row = rows.emplace_back(StillRow(StillCondition::kNight, {}, -1, 0.8, view.least));
    row.name += fmt::format(", to 0.8 m, {}", view.name);
    row.stills.min_altitude_m = view.lowest_m;
    row.stills.max_visible_fraction = view.most;
  }
  return rows;
}

std::vector<Row> StillRows() {
  constexpr double kLow = 6, kHigh = 14;  // m
  constexpr double kMostOfIt = 0.6;       // of the print
  std::vector<Row> rows;
  const auto uavs = UavShadowCasters();
  for (int i = 0; i < std::ssize(uavs); ++i) {
    rows.push_back(StillRow(StillCondition::kUavShadow, uavs, i, kLow, kMostOfIt));
  }
  for (const StillCondition condition :
       {StillCondition::kOtherShadow, StillCondition::kHeldOutShadow}) {
    rows.push_back(StillRow(condition, {}, -1, kLow, kMostOfIt));
  }
  for (const StillCondition condition :
       {StillCondition::kUavShadow, StillCondition::kGlare, StillCondition::kDark,
        StillCondition::kDust, StillCondition::kBlur, StillCondition::kMixed}) {
    rows.push_back(StillRow(condition, {}, -1, kHigh, 0.25));
    rows.back().name += ", to 14 m, a quarter in view";
  }
  rows.push_back(rows.back());
  rows.back().name = "worn, to 14 m, a quarter in view";
  rows.back().stills.wear = 1;
  for (const Row& row : NightRows()) rows.push_back(row);
  return rows;
}

class Report {
 public:
  explicit Report(const Options& options)
      : options_(options), detector_(CameraModel(PaperCamera()), {}) {}

  void PrintPatterns() {
    fmt::print(
        "| light | found | wrong | quality: median, 5 % | centre error px: median, 95 % |\n"
        "|---|---|---|---|---|\n");
    std::uint64_t seed = kPatternSeed;
    for (const Row& row : StillRows()) {
      const std::uint64_t first = std::exchange(seed, seed + kSeedsOfRow);
      if (!IsWanted(row.name)) continue;
      const LandingStillMaker maker(row.stills);
      const auto make = [&](std::size_t i) { return FrameFromStill(maker, row.name, first + i); };
      const std::vector<LandingScore> scores = Score(options_.stills, make, detector_);
      PrintPatternRow(row.name, scores);
      for (const LandingScore& score : scores) AddQuality(row.stills.condition, score);
    }
    for (const LandingFrameSet& set : ReadLandingHard(options_.data_dir)) {
      const std::string name = "another renderer's: " + set.name;
      if (!IsWanted(name)) continue;
      const auto make = [&](std::size_t i) { return set.frames[i]; };
      const LandingPatternDetector detector(CameraModel(set.camera), {});
      PrintPatternRow(name, Score(set.frames.size(), make, detector));
    }
  }

  void PrintLookalikes() {
    fmt::print("\n| without the pattern | taken for it, of |\n|---|---|\n");
    constexpr double kWhole = 1, kCutOff = 0.3;
    const int few = options_.counterfeits;
    std::vector<StillCondition> lights;
    for (int i = 0; i < kStillConditions; ++i) lights.push_back(static_cast<StillCondition>(i));
    PrintLookalikeRow("look-alikes", LookalikeSet::kPlain, lights, kWhole, options_.lookalikes);
    for (const auto& [set, name] : {std::pair(LookalikeSet::kWithCounterfeits, "with counterfeits"),
                                    std::pair(LookalikeSet::kHeldOut, "held-out kinds")}) {
      PrintLookalikeRow(name, set, lights, kWhole, few);
      PrintLookalikeRow(fmt::format("{}, cut off", name), set, lights, kCutOff, few);
    }
    lights = {StillCondition::kNight};
    const LookalikeSet all = LookalikeSet::kWithCounterfeits;
    PrintLookalikeRow("with counterfeits, night", all, lights, kWhole, few);
    PrintLookalikeRow("with counterfeits, cut off, night", all, lights, kCutOff, few);
  }

  // The errors of all detections in a light, right ones and false ones.
  void PrintReliability() const {
    fmt::print("\n| light | detections | expected calibration error |\n|---|---|---|\n");
    for (int i = 0; i < kStillConditions; ++i) {
      const Reliability& reliability = reliability_[i];
      if (reliability.count() == 0) continue;
      fmt::print("| {} | {} | {:.3f} |\n", ToString(static_cast<StillCondition>(i)),
                 reliability.count(), reliability.ExpectedError());
    }
  }

 private:
  void AddQuality(StillCondition light, const LandingScore& score) {
    const bool is_right = score.outcome == LandingOutcome::kFound;
    if (!is_right && score.outcome != LandingOutcome::kWrong) return;
    reliability_[static_cast<int>(light)].Add(score.quality, is_right);
  }

  bool IsWanted(const std::string& row) const { return row.find(options_.row) != row.npos; }

  // Uses each of the lights in turn.
  void PrintLookalikeRow(const std::string& name, LookalikeSet set,
                         std::span<const StillCondition> lights, double min_visible, int count) {
    const std::uint64_t seed = std::exchange(lookalike_seed_, lookalike_seed_ + kSeedsOfRow);
    if (!IsWanted(name)) return;
    std::vector<LandingStillMaker> makers;
    for (const StillCondition light : lights) {
      LandingStillOptions options;
      options.min_altitude_m = 0.4;
      options.max_altitude_m = 14;
      options.condition = light;
      options.lookalikes = set;
      options.min_lookalike_visible = min_visible;
      makers.emplace_back(options);
    }
    const auto make = [&](std::size_t i) {
      const LandingStillMaker& maker = makers[i % makers.size()];
      return FrameFromLookalikes(maker, ToString(maker.options().condition), seed + i);
    };
    const std::vector<LandingScore> scores = Score(count, make, detector_);
    const LandingTally tally(scores);
    fmt::print("| {} | {} of {} |\n", name, tally.false_detections, tally.negatives);
    for (std::size_t i = 0; i < scores.size(); ++i) {
      AddQuality(lights[i % lights.size()], scores[i]);
    }
    std::fflush(stdout);
  }

  std::vector<LandingScore> Score(std::size_t count,
                                  const std::function<LandingFrame(std::size_t)>& make,
                                  const LandingPatternDetector& detector) const {
    return ScoreFrames(
        detector, count, kThreads, NoHint, make,
        [&](const LandingFrame& frame, const LandingScore& score) { Mark(frame, score); });
  }

  void Mark(const LandingFrame& frame, const LandingScore& score) const {
    const bool is_fine =
        score.outcome == LandingOutcome::kFound || score.outcome == LandingOutcome::kQuiet;
    if (is_fine || score.truth == PatternTruth::kUnknown) return;
    if (options_.verbose) {
      fmt::print("- {}: {}; reached {}: {}; ring of {:.0f} px, {:.2f} m, quality {:.3f}\n",
                 score.name, score.outcome == LandingOutcome::kMissed ? "missed" : "wrong",
                 ToString(score.reached), score.reason, 2 * score.ring_radius_px, frame.altitude_m,
                 score.quality);
    }
    if (options_.keep.empty()) return;
    std::string file = score.name;
    std::replace_if(
        file.begin(), file.end(), [](char c) { return c == ' ' || c == '/'; }, '_');
    WriteImage((std::filesystem::path(options_.keep) / (file + ".png")).string(), frame.image);
  }

  static void PrintPatternRow(const std::string& name, const std::vector<LandingScore>& scores) {
    const LandingTally tally(scores);
    if (tally.frames == 0) {
      fmt::print("| {} | | {} of {} | | |\n", name, tally.false_detections, tally.negatives);
      return;
    }
    std::vector<double> qualities;
    for (const LandingScore& score : scores) {
      if (score.outcome == LandingOutcome::kFound) qualities.push_back(score.quality);
    }
    fmt::print("| {} | {} of {} ({:.1f} %) | {} | {:.3f}, {:.3f} | {:.2f}, {:.2f} |\n", name,
               tally.found, tally.frames, 100 * tally.FoundShare(), tally.wrong,
               Quantile(qualities, 0.5), Quantile(qualities, 0.05),
               Quantile(tally.center_errors_px, 0.5), Quantile(tally.center_errors_px, 0.95));
    std::fflush(stdout);
  }

  const Options& options_;
  LandingPatternDetector detector_;
  std::uint64_t lookalike_seed_ = kLookalikeSeed;
  std::array<Reliability, kStillConditions> reliability_;
};

int Run(int argc, char** argv) {
  Options options;
  CLI::App app{"The landing pattern detector by light"};
  app.add_option("--data", options.data_dir, "folder with landing_hard");
  app.add_option("--stills", options.stills, "rendered stills per row");
  app.add_option("--lookalikes", options.lookalikes, "stills of look-alikes, 0: none");
  app.add_option("--counterfeits", options.counterfeits, "stills of each harder set, 0: none");
  app.add_option("--row", options.row, "only rows whose name contains this");
  app.add_flag("--verbose", options.verbose, "list what was missed or wrong, and why");
  app.add_option("--keep", options.keep, "folder for the images of these")
      ->check(CLI::ExistingDirectory);
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  Report report(options);
  if (options.stills > 0) report.PrintPatterns();
  if (options.lookalikes + options.counterfeits > 0) report.PrintLookalikes();
  report.PrintReliability();
  return 0;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  return kestrel::ReportMain([&] { return kestrel::Run(argc, argv); });
}
