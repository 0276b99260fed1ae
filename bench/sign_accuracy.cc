// SPDX-License-Identifier: BSD-3-Clause
// Prints how often signs that are not the landing pattern are taken for it, by kind and exposure,
// whole and cut off, in full light, under shadows and highlights; and how often the pattern is
// found in the same pictures.
#include <array>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "for_each_index.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/core/codec/image_codec.h"
#include "landing_score.h"
#include "landing_signs.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr int kThreads = 2;
constexpr std::array kQualities{0.7, 0.9, 0.95, 0.98, 0.99};

struct Options {
  int stills = 30;
  std::uint64_t seed = 40'000'000;
  bool attitude = false;
  bool verbose = false;
  std::string keep;
};

// Detections that count, of pictures: right ones of the pattern, any of another sign.
struct Count {
  std::array<int, kQualities.size()> at_quality{};
  int of = 0;

  void Add(const LandingScore& score) {
    if (score.truth == PatternTruth::kUnknown) return;
    ++of;
    const LandingOutcome counts =
        score.truth == PatternTruth::kNone ? LandingOutcome::kWrong : LandingOutcome::kFound;
    for (std::size_t i = 0; i < kQualities.size(); ++i) {
      at_quality[i] += score.outcome == counts && score.quality >= kQualities[i];
    }
  }
  Count& operator+=(const Count& other) {
    for (std::size_t i = 0; i < kQualities.size(); ++i) at_quality[i] += other.at_quality[i];
    of += other.of;
    return *this;
  }
  std::string Cell() const { return fmt::format("{} of {}", at_quality.front(), of); }
};

using Counts = std::array<Count, kSignWhites.size()>;

class Report {
 public:
  explicit Report(const Options& options)
      : options_(options), detector_(CameraModel(PaperCamera()), {}) {}

  void Print() {
    fmt::print("| sign |");
    for (const char* extent : {"whole", "cut off"}) {
      for (const double white : kSignWhites) {
        fmt::print(" {}, white {} |", extent, white > 255 ? "saturated" : fmt::to_string(white));
      }
    }
    fmt::print("\n|---|---|---|---|---|---|---|---|---|\n");
    std::array<Count, 3> whole, cut;
    for (std::size_t k = 0; k < SignKinds().size(); ++k) {
      const SignKind& kind = SignKinds()[k];
      const std::uint64_t seed = options_.seed + 200'000 * k;
      const Counts of_whole = Score(kind, false, seed), of_cut = Score(kind, true, seed + 100'000);
      fmt::print("| {} |", kind.name);
      const std::size_t group = kind.is_pattern ? 0 : kind.is_held_out ? 2 : 1;
      for (const Count& count : of_whole) fmt::print(" {} |", count.Cell()), whole[group] += count;
      for (const Count& count : of_cut) fmt::print(" {} |", count.Cell()), cut[group] += count;
      fmt::print("\n");
      std::fflush(stdout);
    }
    fmt::print("\n| at least quality |");
    for (const double quality : kQualities) fmt::print(" {} |", quality);
    fmt::print("\n|---|---|---|---|---|---|\n");
    PrintCurve("the pattern found, whole", whole[0]);
    PrintCurve("the pattern found, cut off", cut[0]);
    PrintCurve("others taken, whole", whole[1]);
    PrintCurve("others taken, cut off", cut[1]);
    PrintCurve("held-out kinds taken, whole", whole[2]);
    PrintCurve("held-out kinds taken, cut off", cut[2]);
  }

 private:
  static void PrintCurve(const char* name, const Count& count) {
    fmt::print("| {}, of {} |", name, count.of);
    for (const int counted : count.at_quality) fmt::print(" {} |", counted);
    fmt::print("\n");
  }

  Counts Score(const SignKind& kind, bool cut_off, std::uint64_t seed) {
    Counts counts;
    std::mutex mutex;
    ForEachIndex(static_cast<std::size_t>(options_.stills), kThreads, [&](std::size_t i) {
      const auto light = static_cast<SignLight>(i % kSignLights);
      const std::vector<LandingFrame> frames = RenderSign(kind, light, cut_off, seed + i);
      const auto workspace = detector_.MakeWorkspace();
      for (std::size_t k = 0; k < frames.size(); ++k) {
        const LandingFrame& frame = frames[k];
        const TargetHint hint = options_.attitude ? AttitudeHint(frame) : NoHint(frame);
        const TargetReport report = detector_.Detect(frame.image, hint, *workspace);
        const LandingScore score = ScoreLanding(frame, report, detector_.camera(), {});
        const std::lock_guard lock(mutex);
        counts[k].Add(score);
        Mark(frame, score);
      }
    });
    return counts;
  }

  void Mark(const LandingFrame& frame, const LandingScore& score) const {
    const bool is_fine =
        score.outcome == LandingOutcome::kFound || score.outcome == LandingOutcome::kQuiet;
    if (is_fine) return;
    if (options_.verbose) {
      fmt::print(stderr, "- {}: {}; reached {}: {}; ring of {:.0f} px, quality {:.3f}\n",
                 frame.name, score.outcome == LandingOutcome::kMissed ? "missed" : "taken",
                 kestrel::ToString(score.reached), score.reason, 2 * frame.ring_radius_px,
                 score.quality);
    }
    if (options_.keep.empty()) return;
    WriteImage((std::filesystem::path(options_.keep) / (frame.name + ".png")).string(),
               frame.image);
  }

  const Options& options_;
  LandingPatternDetector detector_;
};

int Run(int argc, char** argv) {
  Options options;
  CLI::App app{"Signs that are taken for the landing pattern"};
  app.add_option("--stills", options.stills,
                 "stills of each kind, whole and cut off, each at four "
                 "exposures")
      ->check(CLI::PositiveNumber);
  app.add_option("--seed", options.seed, "of the first still");
  app.add_flag("--attitude", options.attitude, "the detector knows its attitude");
  app.add_flag("--verbose", options.verbose, "list what was taken or missed, and why");
  app.add_option("--keep", options.keep, "folder for the images of these")
      ->check(CLI::ExistingDirectory);
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  Report(options).Print();
  return 0;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  return kestrel::ReportMain([&] { return kestrel::Run(argc, argv); });
}
