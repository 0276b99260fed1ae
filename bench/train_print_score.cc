// SPDX-License-Identifier: BSD-3-Clause
// Trains the score that says how probably a print is the pattern, on seeded stills: patterns on
// flat and bent boards, look-alikes, each still as it is, as another camera has it with a
// calibration that may be wrong, and hard to see. A fifth of the stills is held out and measured
// afterwards, and so are the real frames.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/os.h>
#include <opencv2/core.hpp>

#include "kestrel/base/error.h"
#include "kestrel/landing/landing_search.h"
#include "landing_falsehoods.h"
#include "landing_frames.h"
#include "landing_hardships.h"
#include "landing_score.h"
#include "landing_variants.h"
#include "print_score_training.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr int kThreads = 2;

// Of a still with the pattern, a print that lies so near to it is the pattern, and what is farther
// off than the second is something else: ring radii, and least pixels.
constexpr double kSame = 0.1, kOther = 0.15;
constexpr double kSamePx = 2, kOtherPx = 4;
constexpr double kSameSize = 1.33;  // times

// How a still is changed before it is searched.
enum class Change { kNone, kOtherCamera, kHardToSee };

// Frames that are made one by one.
struct StillSource {
  std::string name;
  CameraIntrinsics camera;
  std::size_t count;
  std::function<LandingFrame(std::size_t)> make;
  std::vector<Change> changes;
};

StillSource Patterns(const PrintError& print, std::size_t count, std::uint64_t seed) {
  const auto make = [makers = StillMakers(print), seed](std::size_t i) {
    constexpr std::uint64_t kBinSeeds = 1'000'000;
    const std::size_t bin = i % makers.size();
    return FrameFromStill(makers[bin], std::string(kAltitudeBins[bin].Name()),
                          seed + kBinSeeds * bin + i / makers.size());
  };
  return {std::string(print.name),
          PaperCamera(),
          count,
          make,
          {Change::kNone, Change::kOtherCamera, Change::kHardToSee}};
}

// Axes of the circles in pixels.
struct Extent {
  double min_major_px;
  double min_minor_px;
  double max_minor_px;
};

StillSource Lookalikes(const std::string& name, const Extent& extent, std::size_t count,
                       std::uint64_t seed) {
  LandingStillOptions options;
  options.min_altitude_m = kAltitudeBins.front().min_m;
  options.max_altitude_m = kAltitudeBins.back().max_m;
  options.min_lookalike_major_px = extent.min_major_px;
  options.min_lookalike_minor_px = extent.min_minor_px;
  options.max_lookalike_minor_px = extent.max_minor_px;
  options.counterfeits = true;
  const auto make = [name, seed, maker = LandingStillMaker(options)](std::size_t i) {
    return FrameFromLookalikes(maker, name, seed + i);
  };
  return {
      name, PaperCamera(), count, make, {Change::kNone, Change::kOtherCamera, Change::kHardToSee}};
}

// 'stills': with a flat print.
std::vector<StillSource> Stills(std::size_t stills) {
  constexpr std::uint64_t kPatternSeed = 20'000'000, kBentSeed = 30'000'000,
                          kLookalikeSeed = 40'000'000, kSmallSeed = 50'000'000,
                          kFlatSeed = 60'000'000;
  std::vector<StillSource> sources;
  const std::span<const PrintError> prints = PrintErrors();
  sources.push_back(Patterns(prints.front(), stills, kPatternSeed));
  for (std::size_t i = 1; i < prints.size(); ++i) {
    sources.push_back(Patterns(prints[i], stills / 7, kBentSeed + 1'000'000 * (i - 1)));
  }
  sources.push_back(Lookalikes("look-alikes", {26, 15, 1e9}, stills * 5 / 3, kLookalikeSeed));
  sources.push_back(Lookalikes("small look-alikes", {18, 6, 1e9}, stills, kSmallSeed));
  sources.push_back(
      Lookalikes("look-alikes seen from the side", {30, 6, 14}, stills / 2, kFlatSeed));
  return sources;
}

std::vector<StillSource> RealFrames() {
  std::vector<StillSource> sources;
  for (const auto& sets : {ReadLandingReal(KESTREL_DATA_DIR), ReadLandingHard(KESTREL_DATA_DIR)}) {
    for (const LandingFrameSet& set : sets) {
      sources.push_back({set.name,
                         set.camera,
                         set.frames.size(),
                         [frames = set.frames](std::size_t i) { return frames[i]; },
                         {Change::kNone}});
    }
  }
  return sources;
}

// Changes the image, and chooses a calibration.
cv::Mat Apply(Change change, std::uint64_t seed, const cv::Mat& image, std::size_t* calibration) {
  std::mt19937_64 random(seed);
  const auto apply_one_of = [&](std::span<const ImageVariant> variants) {
    return variants[random() % variants.size()].apply(image, seed);
  };
  *calibration = 0;
  if (change == Change::kNone) return image;
  if (change == Change::kHardToSee) return apply_one_of(Hardships());
  *calibration = random() % CalibrationErrors().size();
  return apply_one_of(ImageVariants());
}

// What a print is of a frame; nothing when that cannot be told.
std::optional<bool> IsPattern(const PrintFinding& print, const LandingFrame& frame) {
  if (frame.truth == PatternTruth::kNone) return false;
  const double radius_px = frame.ring_radius_px;
  const double error_px = (print.center_px - frame.center_px).norm();
  const double size = print.is_part() ? 1 : 0.5 * print.diameters_px.x() / radius_px;
  if (error_px < std::max(kSamePx, kSame * radius_px) && std::max(size, 1 / size) < kSameSize) {
    return true;
  }
  if (error_px < std::max(kOtherPx, kOther * radius_px)) return std::nullopt;
  return false;
}

std::vector<ScoredFrame> Search(const StillSource& source) {
  LandingPatternDetectorOptions options;
  options.min_quality = 1;  // nothing ends the search
  std::vector<std::unique_ptr<LandingModels>> models;
  for (const CalibrationError& error : CalibrationErrors()) {
    models.push_back(
        std::make_unique<LandingModels>(CameraModel(error.apply(source.camera)), options));
  }
  std::vector<ScoredFrame> frames;
  std::mutex mutex;
  ForEachIndex(source.count, kThreads, [&](std::size_t i) {
    const LandingFrame frame = source.make(i);
    if (frame.truth != PatternTruth::kWhole && frame.truth != PatternTruth::kNone) return;
    const auto buffers = std::make_unique<LandingWorkspace::Buffers>();
    for (const Change change : source.changes) {
      const auto number = static_cast<std::size_t>(change);
      std::size_t calibration = 0;
      const cv::Mat image = Apply(change, 7919 * i + number, frame.image, &calibration);
      ScoredFrame scored{
          fmt::format("{}:{}:{}", source.name, i, number), frame.truth == PatternTruth::kWhole, {}};
      std::replace(scored.name.begin(), scored.name.end(), ' ', '_');
      const FindingObserver observer = [&](const PrintFinding& print) {
        const std::optional<bool> is_pattern = IsPattern(print, frame);
        if (is_pattern) scored.prints.push_back({print.kind, print.doubts, *is_pattern});
      };
      const LandingHint no_hint;
      LandingSearch(*models[calibration], image, no_hint, buffers.get(), &observer).Run();
      const std::lock_guard lock(mutex);
      frames.push_back(std::move(scored));
    }
  });
  // Threads finish in any order.
  std::sort(frames.begin(), frames.end(),
            [](const ScoredFrame& a, const ScoredFrame& b) { return a.name < b.name; });
  return frames;
}

// --- Findings as a file, for rendering them takes an hour: one line a frame, one a print. ---

void Write(const std::vector<ScoredFrame>& frames, const std::string& file) {
  auto out = fmt::output_file(file);
  for (const ScoredFrame& frame : frames) {
    out.print("{} {} {}\n", frame.name, static_cast<int>(frame.has_pattern), frame.prints.size());
    for (const ScoredPrint& print : frame.prints) {
      out.print("{} {}", static_cast<int>(print.kind), static_cast<int>(print.is_pattern));
      for (std::size_t i = 0; i < kPrintDoubts; ++i) {
        out.print(" {:.5g}", std::max(-99.0, print.doubts[static_cast<PrintDoubt>(i)]));
      }
      out.print("\n");
    }
  }
}

std::vector<ScoredFrame> Read(const std::string& file) {
  std::ifstream in(file);
  std::vector<ScoredFrame> frames;
  ScoredFrame frame;
  std::size_t prints = 0;
  while (in >> frame.name >> frame.has_pattern >> prints) {
    frame.prints.assign(prints, {});
    for (ScoredPrint& print : frame.prints) {
      int kind = 0;
      in >> kind >> print.is_pattern;
      print.kind = static_cast<PrintKind>(kind);
      for (std::size_t i = 0; i < kPrintDoubts; ++i) in >> print.doubts[static_cast<PrintDoubt>(i)];
    }
    if (!in)
      throw InputError(fmt::format("{}: frame {}: expected {} prints of {} doubts", file,
                                   frame.name, prints, kPrintDoubts));
    frames.push_back(frame);
  }
  if (frames.empty()) throw InputError(fmt::format("{}: expected findings of frames", file));
  return frames;
}

std::vector<ScoredFrame> SearchAll(const std::vector<StillSource>& sources) {
  std::vector<ScoredFrame> all;
  for (const StillSource& source : sources) {
    const std::vector<ScoredFrame> frames = Search(source);
    fmt::print(stderr, "{}: {} frames\n", source.name, frames.size());
    all.insert(all.end(), frames.begin(), frames.end());
  }
  return all;
}

// Of a still all its changes are held out, or none.
bool IsHeldOut(const ScoredFrame& frame) {
  const std::size_t first = frame.name.find(':'), last = frame.name.rfind(':');
  return std::stoul(frame.name.substr(first + 1, last - first - 1)) % 5 == 4;
}

void Report(const std::string& name, const PrintScore& score,
            const std::vector<ScoredFrame>& frames) {
  if (frames.empty()) return;
  const Reliability reliability = MeasureReliability(score, frames);
  fmt::print("\n## {}\n\n{} frames, expected calibration error {:.4f}\n\n", name, frames.size(),
             reliability.expected_calibration_error);
  fmt::print("| quality | detections | mean quality | right |\n|---|---|---|---|\n");
  for (std::size_t i = 0; i < reliability.bins.size(); ++i) {
    const ReliabilityBin& bin = reliability.bins[i];
    fmt::print("| {:.1f} to {:.1f} | {} | {:.3f} | {:.3f} |\n", 0.1 * static_cast<double>(i),
               0.1 * static_cast<double>(i + 1), bin.count, bin.mean_quality, bin.right);
  }
  fmt::print("\n| least quality | found | false, of frames without |\n|---|---|---|\n");
  for (const double quality : {0.3, 0.5, 0.7, 0.8, 0.9, 0.95}) {
    const DetectionRates rates = MeasureRates(score, frames, quality);
    fmt::print("| {:.2f} | {:.2f} % | {:.2f} % |\n", quality, 100 * rates.found,
               100 * rates.false_of_all);
  }
}

void Run(const std::string& output, const std::string& findings, std::size_t stills) {
  std::vector<ScoredFrame> frames;
  if (!findings.empty() && std::filesystem::exists(findings)) {
    frames = Read(findings);
  } else {
    frames = SearchAll(Stills(stills));
    if (!findings.empty()) Write(frames, findings);
  }
  const auto held_out = std::stable_partition(
      frames.begin(), frames.end(), [](const ScoredFrame& frame) { return !IsHeldOut(frame); });
  const std::vector<ScoredFrame> tests(held_out, frames.end());
  frames.erase(held_out, frames.end());
  const PrintScore score = TrainPrintScore(frames);
  Report("Stills that were trained on", score, frames);
  Report("Held-out stills", score, tests);
  Report("Real and hard frames", score, SearchAll(RealFrames()));
  if (!output.empty()) fmt::output_file(output).print("{}", ToSource(score));
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("Trains the score of prints on seeded stills; an hour or two on two cores.");
  std::string output, findings;
  std::size_t stills = 1500;
  app.add_option("--output", output, "Header to write, print_score_weights.h");
  app.add_option("--findings", findings, "File of findings: read when it is there, else written");
  app.add_option("--stills", stills, "Stills with a flat print; of others in proportion");
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  return kestrel::ReportMain([&] {
    kestrel::Run(output, findings, stills);
    return 0;
  });
}
