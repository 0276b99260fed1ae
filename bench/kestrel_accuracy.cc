// SPDX-License-Identifier: BSD-3-Clause
// Prints how well the landing pattern is found on the real frames, on independently rendered stills
// and on our own, as Markdown tables, and compares the results with the limits.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/codec/image_codec.h"
#include "landing_frames.h"
#include "landing_score.h"
#include "landing_variants.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr int kThreads = 2;

struct Options {
  std::string data_dir = KESTREL_DATA_DIR;
  int stills = 500;
  bool variants = false;
  bool verbose = false;
  std::string misses_dir;
};

struct Limit {
  std::string_view what;
  bool at_least;
  double bound;
};

// The limits. Shares and errors of the position in percent.
constexpr Limit kLimits[] = {
    {"real: found, %", true, 99},
    {"real: detections elsewhere or without pattern", false, 0},
    {"real: partial rings found wrongly", false, 0},
    {"real: centre error, median, px", false, 0.6},
    {"real: centre error, 95 %, px", false, 2},
    {"hard: found, %", true, 90},
    {"hard: false detections", false, 0},
    {"hard: false detections, look-alikes", false, 0},
    {"hard, attitude known: found, %", true, 90},
    {"hard, attitude known: false detections", false, 0},
    {"hard, attitude known: false detections, look-alikes", false, 0},
    {"stills 0.35 to 1 m: found, %", true, 90},
    {"stills 1 to 2 m: found, %", true, 97},
    {"stills 2 to 6 m: found, %", true, 100},
    {"stills 6 to 9 m: found, %", true, 99},
    {"stills 9 to 14 m: found, %", true, 95},
    {"stills: detections elsewhere", false, 0},
    {"stills: position error, median, % of the distance", false, 1},
    {"stills: false detections, look-alikes", false, 0},
};

using Measured = std::map<std::string, double>;

// Prints the limits. Returns true when all that were measured hold.
bool PrintLimits(const Measured& measured) {
  fmt::print("\n## Limits\n\n| limit | wanted | measured | |\n|---|---|---|---|\n");
  bool all_hold = true;
  for (const Limit& limit : kLimits) {
    const auto value = measured.find(std::string(limit.what));
    const char* relation = limit.at_least ? ">=" : "<=";
    if (value == measured.end()) {
      fmt::print("| {} | {} {} | - | not measured |\n", limit.what, relation, limit.bound);
      continue;
    }
    const bool holds = limit.at_least ? value->second >= limit.bound : value->second <= limit.bound;
    all_hold = all_hold && holds;
    fmt::print("| {} | {} {} | {:.4g} | {} |\n", limit.what, relation, limit.bound, value->second,
               holds ? "pass" : "**FAIL**");
  }
  return all_hold;
}

const char* ToString(LandingOutcome outcome) {
  switch (outcome) {
    case LandingOutcome::kFound:
      return "found";
    case LandingOutcome::kMissed:
      return "missed";
    case LandingOutcome::kWrong:
      return "wrong";
    case LandingOutcome::kQuiet:
      return "quiet";
  }
  return "";
}

// Returns one line about a fault, with the reason.
std::string Describe(const LandingFrame& frame, const LandingScore& score) {
  std::string line = fmt::format("- {}: {}", score.name, ToString(score.outcome));
  if (frame.truth != PatternTruth::kNone) {
    const Eigen::Vector2d center = frame.outer ? frame.outer->center : frame.center_px;
    line += fmt::format(", ring of {:.0f} px at {:.0f} {:.0f}", 2 * frame.ring_radius_px,
                        center.x(), center.y());
  }
  if (frame.altitude_m > 0) line += fmt::format(", {:.2f} m", frame.altitude_m);
  if (frame.visible_fraction < 1) line += fmt::format(", {:.2f} in view", frame.visible_fraction);
  if (score.outcome == LandingOutcome::kMissed) {
    return line + fmt::format("; reached {}: {}", kestrel::ToString(score.reached), score.reason);
  }
  return line + fmt::format("; detected at {:.0f} {:.0f} with quality {:.2f}",
                            score.detected_px.x(), score.detected_px.y(), score.quality);
}

// Collects the faults, and writes their images if the user wants them.
class FaultLog {
 public:
  explicit FaultLog(const Options& options) : options_(options) {}

  void See(const LandingFrame& frame, const LandingScore& score) {
    if (score.truth == PatternTruth::kUnknown || score.outcome == LandingOutcome::kFound ||
        score.outcome == LandingOutcome::kQuiet) {
      return;
    }
    lines_[score.name] = Describe(frame, score);
    if (!options_.misses_dir.empty()) Write(frame, score);
  }

  void PrintAndClear() {
    if (options_.verbose) {
      for (const auto& [name, line] : lines_) fmt::print("{}\n", line);
    }
    lines_.clear();
  }

 private:
  void Write(const LandingFrame& frame, const LandingScore& score) const {
    std::string name = fmt::format("{}_{}", ToString(score.outcome), score.name);
    std::replace_if(
        name.begin(), name.end(), [](char c) { return !std::isalnum(c) && c != '.'; }, '_');
    std::filesystem::create_directories(options_.misses_dir);
    const std::string file = options_.misses_dir + "/" + name + ".png";
    WriteImage(file, frame.image);
  }

  const Options& options_;
  std::map<std::string, std::string> lines_;
};

std::vector<LandingScore> ScoreSet(const LandingFrameSet& set, HintOf hint, FaultLog* faults) {
  const LandingPatternDetector detector(CameraModel(set.camera), {});
  return ScoreFrames(
      detector, set.frames.size(), kThreads, hint, [&](std::size_t i) { return set.frames[i]; },
      [&](const LandingFrame& frame, const LandingScore& score) { faults->See(frame, score); });
}

double Percent(double share) { return 100 * share; }

// --- Real frames ---

void PrintRealRow(const std::string& name, const LandingTally& t) {
  fmt::print("| {} | {} | {} | {} | {:.2f} | {:.2f} | {} | {} | {} | {} | {} |\n", name, t.frames,
             t.found, t.wrong, Quantile(t.center_errors_px, 0.5),
             Quantile(t.center_errors_px, 0.95), t.negatives, t.false_detections, t.partial,
             t.partial_found, t.partial_right);
}

void PrintRealHeader(std::string_view first) {
  fmt::print(
      "\n| {} | scored | found | wrong | centre error median, px | 95 %, px | without pattern | "
      "false | partial | found | right |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
      first);
}

void PrintRealByRingSize(const std::vector<LandingScore>& scores) {
  constexpr double kRadii_px[] = {0, 20, 30, 40, 50, 70, 1000};
  PrintRealHeader("ring radius, px");
  for (std::size_t i = 0; i + 1 < std::size(kRadii_px); ++i) {
    LandingTally tally;
    for (const LandingScore& score : scores) {
      const double radius = score.ring_radius_px;
      if (score.truth != PatternTruth::kNone && radius >= kRadii_px[i] &&
          radius < kRadii_px[i + 1]) {
        tally.Add(score);
      }
    }
    if (tally.frames + tally.partial > 0) {
      PrintRealRow(fmt::format("{} to {}", kRadii_px[i], kRadii_px[i + 1]), tally);
    }
  }
}

void ReportReal(const Options& options, Measured* measured) {
  fmt::print("## Real frames\n\nWhole image, no hint, every frame for itself.\n");
  const std::vector<LandingFrameSet> sets = ReadLandingReal(options.data_dir);
  if (sets.empty()) {
    fmt::print("\nskipped: there is no {}/landing_real\n", options.data_dir);
    return;
  }
  FaultLog faults(options);
  std::vector<LandingScore> all;
  PrintRealHeader("sequence");
  for (const LandingFrameSet& set : sets) {
    const std::vector<LandingScore> scores = ScoreSet(set, NoHint, &faults);
    PrintRealRow(set.name, LandingTally(scores));
    all.insert(all.end(), scores.begin(), scores.end());
  }
  const LandingTally total(all);
  PrintRealRow("all", total);
  PrintRealByRingSize(all);
  fmt::print("\n");
  faults.PrintAndClear();
  (*measured)["real: found, %"] = Percent(total.FoundShare());
  (*measured)["real: detections elsewhere or without pattern"] =
      total.wrong + total.false_detections;
  (*measured)["real: partial rings found wrongly"] = total.partial_found - total.partial_right;
  (*measured)["real: centre error, median, px"] = Quantile(total.center_errors_px, 0.5);
  (*measured)["real: centre error, 95 %, px"] = Quantile(total.center_errors_px, 0.95);
}

// --- Independently rendered stills ---

std::string HardCells(const LandingTally& t) {
  return fmt::format("{} | {} | {:.2f} | {}", t.found, t.wrong,
                     Percent(Quantile(t.position_errors, 0.5)), t.false_detections);
}

void PrintHardHeader(std::string_view first) {
  fmt::print(
      "\n| {} | with pattern | without | found | wrong | position error median, % | false | "
      "attitude known: found | wrong | position error median, % | false "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n",
      first);
}

void PrintHardRow(const std::string& name, const LandingTally& blind, const LandingTally& aided) {
  fmt::print("| {} | {} | {} | {} | {} |\n", name, blind.frames, blind.negatives, HardCells(blind),
             HardCells(aided));
}

LandingTally TallyOfBin(const std::vector<LandingScore>& scores, const AltitudeBin& bin) {
  LandingTally tally;
  for (const LandingScore& score : scores) {
    if (score.truth == PatternTruth::kWhole && bin.Contains(score.altitude_m)) tally.Add(score);
  }
  return tally;
}

void MeasureHard(const std::string& prefix, const LandingTally& total, Measured* measured) {
  (*measured)[prefix + ": found, %"] = Percent(total.FoundShare());
  (*measured)[prefix + ": false detections"] = total.wrong;
  (*measured)[prefix + ": false detections, look-alikes"] = total.false_detections;
}

void ReportHard(const Options& options, Measured* measured) {
  fmt::print("\n## Stills of another renderer\n");
  const std::vector<LandingFrameSet> sets = ReadLandingHard(options.data_dir);
  if (sets.empty()) {
    fmt::print("\nskipped: there is no {}/landing_hard\n", options.data_dir);
    return;
  }
  FaultLog blind_faults(options), aided_faults(options);
  std::vector<LandingScore> all_blind, all_aided;
  PrintHardHeader("condition");
  for (const LandingFrameSet& set : sets) {
    const auto blind = ScoreSet(set, NoHint, &blind_faults);
    const auto aided = ScoreSet(set, AttitudeHint, &aided_faults);
    PrintHardRow(set.name, LandingTally(blind), LandingTally(aided));
    all_blind.insert(all_blind.end(), blind.begin(), blind.end());
    all_aided.insert(all_aided.end(), aided.begin(), aided.end());
  }
  PrintHardRow("all", LandingTally(all_blind), LandingTally(all_aided));
  PrintHardHeader("altitude");
  for (const AltitudeBin& bin : kAltitudeBins) {
    PrintHardRow(bin.Name(), TallyOfBin(all_blind, bin), TallyOfBin(all_aided, bin));
  }
  if (options.verbose) fmt::print("\nWithout a hint:\n\n");
  blind_faults.PrintAndClear();
  if (options.verbose) fmt::print("\nAttitude known:\n\n");
  aided_faults.PrintAndClear();
  MeasureHard("hard", LandingTally(all_blind), measured);
  MeasureHard("hard, attitude known", LandingTally(all_aided), measured);
}

// --- The same frames, other pixels ---

LandingTally ScoreVariant(const std::vector<LandingFrameSet>& sets, const ImageVariant& variant) {
  LandingTally tally;
  for (const LandingFrameSet& set : sets) {
    for (const bool left_right : {false, true}) {
      for (const bool top_bottom : {false, true}) {
        const LandingFrameSet mirrored = Mirrored(set, left_right, top_bottom);
        const LandingPatternDetector detector(CameraModel(mirrored.camera), {});
        const auto scores =
            ScoreFrames(detector, mirrored.frames.size(), kThreads, NoHint, [&](std::size_t i) {
              LandingFrame frame = mirrored.frames[i];
              frame.image = variant.apply(frame.image, i);
              return frame;
            });
        for (const LandingScore& score : scores) tally.Add(score);
      }
    }
  }
  return tally;
}

void ReportVariants(const Options& options) {
  if (!options.variants) return;
  fmt::print("\n## The same frames, other pixels\n\n");
  const std::vector<LandingFrameSet> real = ReadLandingReal(options.data_dir);
  const std::vector<LandingFrameSet> hard = ReadLandingHard(options.data_dir);
  if (real.empty() && hard.empty()) {
    fmt::print("skipped: there is no landing_real or landing_hard in {}\n", options.data_dir);
    return;
  }
  fmt::print(
      "Every frame also seen in mirrors: four of each.\n\n"
      "| variant | real frames | real: found | real: wrong | real: without | real: false | stills "
      "| "
      "stills: found | stills: wrong | stills: without | stills: false "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  const auto cells = [](const LandingTally& t) {
    return fmt::format("{} | {} | {} | {} | {}", t.frames, t.found, t.wrong, t.negatives,
                       t.false_detections);
  };
  for (const ImageVariant& variant : ImageVariants()) {
    fmt::print("| {} | {} | {} |\n", variant.name, cells(ScoreVariant(real, variant)),
               cells(ScoreVariant(hard, variant)));
    std::fflush(stdout);
  }
}

// --- Our own stills ---

// Stills of one bin have seeds of their own, the same in every run.
std::uint64_t Seed(std::size_t bin, std::size_t index) { return 1'000'000 * (bin + 1) + index; }

std::vector<LandingScore> ReportStillsOfBin(std::size_t bin, int stills, FaultLog* faults) {
  LandingStillOptions options;
  options.min_altitude_m = kAltitudeBins[bin].min_m;
  options.max_altitude_m = kAltitudeBins[bin].max_m;
  const LandingStillMaker maker(options);
  const LandingPatternDetector detector(maker.camera(), {});
  const std::string name = kAltitudeBins[bin].Name();
  std::vector<LandingScore> scores = ScoreFrames(
      detector, stills, kThreads, NoHint,
      [&](std::size_t i) { return FrameFromStill(maker, name, Seed(bin, i)); },
      [&](const LandingFrame& frame, const LandingScore& score) { faults->See(frame, score); });
  const LandingTally t(scores);
  fmt::print(
      "| {} | {} | {:.1f} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.1f} | {:.1f} | {} of {} "
      "|\n",
      name, t.frames, Percent(t.FoundShare()), t.wrong, Quantile(t.center_errors_px, 0.5),
      Quantile(t.center_errors_px, 0.95), Percent(Quantile(t.position_errors, 0.5)),
      Percent(Quantile(t.position_errors, 0.95)), Mean(t.nees), Quantile(t.nees, 0.5), t.mirrored,
      t.with_mirror);
  std::fflush(stdout);
  return scores;
}

// Found of all, by altitude and by hardship.
void PrintStillsByGroup(const std::vector<std::vector<LandingScore>>& bins) {
  fmt::print("\n| found of |");
  for (const AltitudeBin& bin : kAltitudeBins) fmt::print(" {} |", bin.Name());
  fmt::print(" all |\n|---|---|---|---|---|---|---|\n");
  for (const char* group : kStillGroups) {
    fmt::print("| {} |", group);
    LandingTally all;
    for (const std::vector<LandingScore>& scores : bins) {
      LandingTally tally;
      for (const LandingScore& score : scores) {
        if (score.group == group) tally.Add(score);
      }
      fmt::print(" {} of {} |", tally.found, tally.frames);
      all.Add(tally);
    }
    fmt::print(" {} of {} |\n", all.found, all.frames);
  }
}

LandingTally ScoreLookalikes(int stills, FaultLog* faults) {
  LandingStillOptions options;
  options.min_altitude_m = kAltitudeBins.front().min_m;
  options.max_altitude_m = kAltitudeBins.back().max_m;
  const LandingStillMaker maker(options);
  const LandingPatternDetector detector(maker.camera(), {});
  return LandingTally(ScoreFrames(
      detector, stills, kThreads, NoHint,
      [&](std::size_t i) {
        return FrameFromLookalikes(maker, "look-alikes", Seed(kAltitudeBins.size(), i));
      },
      [&](const LandingFrame& frame, const LandingScore& score) { faults->See(frame, score); }));
}

void ReportStills(const Options& options, Measured* measured) {
  if (options.stills == 0) return;
  fmt::print(
      "\n## Our own stills\n\nThe paper's lens, tilt to 40 degrees, anywhere in the lens circle, "
      "at least a quarter of the pattern in view. NEES of the position: 3 is right.\n\n"
      "| altitude | stills | found, % | wrong | centre error median, px | 95 %, px | position "
      "error median, % | 95 %, % | NEES mean | median | mirror pose was the right one "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  FaultLog faults(options);
  std::vector<std::vector<LandingScore>> bins;
  std::vector<double> position_errors;
  int wrong = 0;
  for (std::size_t bin = 0; bin < kAltitudeBins.size(); ++bin) {
    bins.push_back(ReportStillsOfBin(bin, options.stills, &faults));
    const LandingTally tally(bins.back());
    (*measured)[fmt::format("stills {}: found, %", kAltitudeBins[bin].Name())] =
        Percent(tally.FoundShare());
    position_errors.insert(position_errors.end(), tally.position_errors.begin(),
                           tally.position_errors.end());
    wrong += tally.wrong;
  }
  PrintStillsByGroup(bins);
  const LandingTally lookalikes = ScoreLookalikes(options.stills, &faults);
  fmt::print("\nLook-alikes: {} images, {} false detections.\n\n", lookalikes.negatives,
             lookalikes.false_detections);
  faults.PrintAndClear();
  (*measured)["stills: detections elsewhere"] = wrong;
  (*measured)["stills: position error, median, % of the distance"] =
      Percent(Quantile(position_errors, 0.5));
  (*measured)["stills: false detections, look-alikes"] = lookalikes.false_detections;
}

int Run(int argc, char** argv) {
  Options options;
  CLI::App app{"Accuracy of the landing pattern detector"};
  app.add_option("--data", options.data_dir, "folder with landing_real and landing_hard");
  app.add_option("--stills", options.stills, "rendered stills per altitude, and look-alikes")
      ->check(CLI::NonNegativeNumber);
  app.add_flag("--variants", options.variants,
               "the given frames mirrored, and in other exposure, noise, blur and compression");
  app.add_flag("--verbose", options.verbose, "list what was missed or wrong, and why");
  app.add_option("--misses", options.misses_dir, "folder for the images of what went wrong");
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  Measured measured;
  ReportReal(options, &measured);
  ReportHard(options, &measured);
  ReportVariants(options);
  ReportStills(options, &measured);
  return PrintLimits(measured) ? 0 : 1;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  return kestrel::ReportMain([&] { return kestrel::Run(argc, argv); });
}
