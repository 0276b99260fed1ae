// SPDX-License-Identifier: BSD-3-Clause
// Trains the score that gives the probability that a print is the pattern, on seeded stills:
// patterns on flat and bent boards, and look-alikes. Each still is used as it is, as another camera
// would show it with a calibration that may be wrong, and hard to see. A fifth of the stills is
// held out and measured afterwards, and so are the real frames.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
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

#include "for_each_index.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/codec/image_codec.h"
#include "kestrel/io/recording/media/image_file.h"
#include "kestrel/vision/landing/landing_search.h"
#include "landing_falsehoods.h"
#include "landing_frames.h"
#include "landing_hardships.h"
#include "landing_score.h"
#include "landing_signs.h"
#include "landing_variants.h"
#include "print_score_training.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr int kThreads = 2;

// In a still with the pattern, a print nearer to it than the first limit is the pattern, and one
// farther than the second is something else: ring radii, and least pixels.
constexpr double kSame = 0.1, kOther = 0.15;
constexpr double kSamePx = 2, kOtherPx = 4;
constexpr double kSameSize = 1.33;  // factor

// Change of a still before the search.
enum class Change { kNone, kOtherCamera, kHardToSee };

// A source of frames that are made one by one.
struct TrainingSource {
  std::string name;
  CameraIntrinsics camera;
  std::size_t count;
  std::function<LandingFrame(std::size_t)> make;
  std::vector<Change> changes;
  unsigned hardships = 0;  // of all its frames, see ScoredFrame
  bool is_held_out = false;
};

unsigned BitOf(StillCondition condition) { return 1u << static_cast<unsigned>(condition); }
enum FrameHardship : unsigned { kSmallFrame, kNearFrame, kCutOffFrame, kWornFrame };
unsigned BitOf(FrameHardship hardship) { return 1u << (kStillConditions + hardship); }

std::string NameOf(unsigned bit) {
  return bit < kStillConditions ? ToString(static_cast<StillCondition>(bit))
                                : std::string(kFrameHardships[bit - kStillConditions]);
}

// Returns a still whose image is kept in a folder: it is read if it exists, else rendered and
// written. Empty folder: nothing is kept. The seeds follow from the order of the sources: a new one
// comes last, or the folder is emptied.
template <class Still>
Still Kept(const std::string& folder, const std::string& name, const std::function<Still()>& place,
           const std::function<Still()>& render) {
  if (folder.empty()) return render();
  const std::string file = (std::filesystem::path(folder) / (name + ".png")).string();
  Still still = std::filesystem::exists(file) ? place() : render();
  if (still.image.empty()) {
    still.image = ReadGrayImage(file);
  } else {
    WriteImage(file, still.image);
  }
  return still;
}

// All stills for training and testing; their number is proportional to 'scale'.
class StillSources {
 public:
  StillSources(double scale, std::string image_folder)
      : scale_(scale), image_folder_(std::move(image_folder)) {
    AddPatterns();
    AddLookalikes();
    AddWorn();
    for (int c = 1; c < kStillConditions; ++c) AddFlatLookalikes(c, 80);
    for (const SignKind& kind : SignKinds()) {
      if (!kind.is_held_out) AddSigns(kind);
    }
    AddNarrowLens();
  }

  std::vector<TrainingSource> Take() { return std::move(sources_); }

 private:
  static constexpr double kLowest = 0.35, kHighest = 14;  // m
  static constexpr double kCutOff = 0.25;                 // smallest part of a look-alike in view
  static constexpr std::uint64_t kFirstSeed = 120'000'000, kSeedsOfSource = 1'000'000;

  // Near stills are as frequent as far ones.
  static constexpr std::array<AltitudeBin, 5> kBins{
      {{kLowest, 1}, {1, 2}, {2, 4}, {4, 8}, {8, kHighest}}};

  void AddPatterns() {
    constexpr std::array<int, kStillConditions> kStills{500, 600, 400, 300, 500,
                                                        500, 250, 250, 400};
    for (int c = 0; c < kStillConditions; ++c) {
      for (const AltitudeBin& bin : kBins) {
        LandingStillOptions options = OptionsOf(c);
        options.min_altitude_m = bin.min_m;
        options.max_altitude_m = bin.max_m;
        // At night small prints drown in noise.
        const bool is_seen = options.condition != StillCondition::kNight || bin.max_m <= 2;
        AddPattern(fmt::format("{}, {}", ToString(options.condition), bin.Name()), options,
                   is_seen ? kStills[c] / static_cast<int>(kBins.size()) : 0);
      }
    }
    // Below 3 m most prints are cut off by the image.
    constexpr int kCut = 90;
    for (int c = 0; c < kStillConditions; ++c) {
      LandingStillOptions options = OptionsOf(c);
      options.max_altitude_m = 3;
      options.max_visible_fraction = 0.75;
      AddPattern(fmt::format("{}, cut off", ToString(options.condition)), options, kCut);
    }
    constexpr int kBent = 60;
    for (const PrintError& print : PrintErrors().subspan(1)) {
      LandingStillOptions options = OptionsOf(0);
      options.bulge = print.bulge;
      options.fold = print.fold;
      options.rolling_skew = print.rolling_skew;
      AddPattern(std::string(print.name), options, kBent);
    }
  }

  void AddLookalikes() {
    for (int c = 0; c < kStillConditions; ++c) {
      const bool is_mixed = c == 0;
      LandingStillOptions whole = OptionsOf(c);
      whole.lookalikes = LookalikeSet::kWithCounterfeits;
      LandingStillOptions cut = whole, small = whole;
      cut.min_lookalike_visible = kCutOff;
      small.min_lookalike_major_px = 18;
      small.min_lookalike_minor_px = 6;
      AddLookalike("look-alikes", whole, is_mixed ? 400 : 160);
      AddLookalike("look-alikes cut off", cut, is_mixed ? 250 : 80);
      AddLookalike("small look-alikes", small, is_mixed ? 200 : 60);
      constexpr int kHeldOut = 40;
      whole.lookalikes = cut.lookalikes = LookalikeSet::kHeldOut;
      AddLookalike("held-out look-alikes", whole, kHeldOut);
      AddLookalike("held-out look-alikes cut off", cut, kHeldOut);
    }
    AddFlatLookalikes(0, 200);
  }

  // A lens of 90 degrees shows no ring in the last decimetres.
  void AddNarrowLens() {
    constexpr int kNarrow = 60;
    for (int c = 0; c < kStillConditions; ++c) {
      LandingStillOptions options = OptionsOf(c);
      options.camera = {.width_px = 640,
                        .height_px = 480,
                        .fx_px = 320,
                        .fy_px = 320,
                        .cx_px = 319.5,
                        .cy_px = 239.5,
                        .distortion_model = DistortionModel::kNone,
                        .distortion = {}};
      options.min_altitude_m = 0.2;
      options.max_altitude_m = 1.2;
      options.max_tilt_deg = 20;
      options.min_visible_fraction = 0.15;
      AddPattern(fmt::format("{}, lens of 90 degrees", ToString(options.condition)), options,
                 kNarrow);
      options.lookalikes = LookalikeSet::kWithCounterfeits;
      options.max_altitude_m = kHighest;
      options.min_lookalike_visible = kCutOff;
      AddLookalike("look-alikes in a lens of 90 degrees", options, kNarrow);
    }
  }

  // Adds prints and look-alikes that are dirty and scraped.
  void AddWorn() {
    for (const AltitudeBin& bin : kBins) {
      LandingStillOptions options = OptionsOf(0);
      options.min_altitude_m = bin.min_m;
      options.max_altitude_m = bin.max_m;
      options.wear = 1;
      AddPattern("worn, " + bin.Name(), options, 90);
    }
    LandingStillOptions whole = OptionsOf(0);
    whole.lookalikes = LookalikeSet::kWithCounterfeits;
    whole.wear = 1;
    LandingStillOptions cut = whole;
    cut.min_lookalike_visible = kCutOff;
    AddLookalike("worn look-alikes", whole, 300);
    AddLookalike("worn look-alikes cut off", cut, 100);
  }

  void AddFlatLookalikes(int condition, int count) {
    LandingStillOptions options = OptionsOf(condition);
    options.lookalikes = LookalikeSet::kWithCounterfeits;
    options.min_lookalike_major_px = 30;
    options.min_lookalike_minor_px = 6;
    options.max_lookalike_minor_px = 14;
    AddLookalike("look-alikes seen from the side", options, count);
  }

  static LandingStillOptions OptionsOf(int condition) {
    LandingStillOptions options;
    options.condition = static_cast<StillCondition>(condition);
    options.min_altitude_m = kLowest;
    options.max_altitude_m = kHighest;
    return options;
  }

  TrainingSource& Add(const std::string& name, const LandingStillOptions& options, int count) {
    TrainingSource source;
    source.name = name;
    std::replace(source.name.begin(), source.name.end(), ' ', '_');
    source.camera = options.camera;
    source.count = static_cast<std::size_t>(scale_ * count);
    source.changes = {Change::kNone, Change::kOtherCamera};
    if (options.condition == StillCondition::kMixed) source.changes.push_back(Change::kHardToSee);
    source.hardships = options.wear > 0 ? BitOf(kWornFrame) : BitOf(options.condition);
    source.is_held_out = options.condition == StillCondition::kHeldOutShadow ||
                         options.lookalikes == LookalikeSet::kHeldOut;
    sources_.push_back(std::move(source));
    return sources_.back();
  }

  std::uint64_t FirstSeed() const { return kFirstSeed + kSeedsOfSource * (sources_.size() - 1); }

  void AddPattern(const std::string& name, const LandingStillOptions& options, int count) {
    TrainingSource& source = Add(name, options, count);
    source.make = [maker = std::make_shared<LandingStillMaker>(options), folder = image_folder_,
                   name = source.name, first = FirstSeed()](std::size_t i) {
      const auto still = Kept<LandingStill>(
          folder, fmt::format("{}_{}", name, i), [&] { return maker->PlacePattern(first + i); },
          [&] { return maker->MakePattern(first + i); });
      return FrameFromStill(still, name, first + i);
    };
  }

  void AddLookalike(const std::string& kind, const LandingStillOptions& options, int count) {
    TrainingSource& source =
        Add(fmt::format("{}, {}", kind, ToString(options.condition)), options, count);
    if (options.min_lookalike_visible < 1) source.hardships |= BitOf(kCutOffFrame);
    if (options.min_lookalike_minor_px < 10) source.hardships |= BitOf(kSmallFrame);
    source.make = [maker = std::make_shared<LandingStillMaker>(options), folder = image_folder_,
                   name = source.name, first = FirstSeed()](std::size_t i) {
      const auto still = Kept<LookalikeStill>(
          folder, fmt::format("{}_{}", name, i), [&] { return maker->PlaceLookalikes(first + i); },
          [&] { return maker->MakeLookalikes(first + i); });
      return FrameFromLookalikes(still, name, first + i);
    };
  }

  // Adds a sign, or the pattern, in all lights and exposures, whole and cut off.
  void AddSigns(const SignKind& kind) {
    constexpr std::size_t kSeeds = 3, kExposures = kSignWhites.size();
    TrainingSource source;
    source.name = std::string("sign, ") + kind.name;
    std::replace(source.name.begin(), source.name.end(), ' ', '_');
    source.camera = PaperCamera();
    source.count = static_cast<std::size_t>(scale_ * kSeeds * kSignLights * 2) * kExposures;
    source.changes = {Change::kNone, Change::kOtherCamera};
    sources_.push_back(std::move(source));
    sources_.back().make = [&kind, first = FirstSeed()](std::size_t i) {
      const auto light = static_cast<SignLight>(i / kExposures % kSignLights);
      const bool is_cut_off = i / kExposures / kSignLights % 2 == 1;
      return RenderSign(kind, light, is_cut_off, first + i / kExposures)[i % kExposures];
    };
  }

  double scale_;
  std::string image_folder_;
  std::vector<TrainingSource> sources_;
};

std::vector<TrainingSource> RealFrames() {
  std::vector<TrainingSource> sources;
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

unsigned HardshipsOf(const LandingFrame& frame) {
  constexpr double kSmallPx = 30, kNear_m = 1, kWhole = 0.75;
  unsigned hardships = 0;
  if (frame.altitude_m > 0 && frame.altitude_m < kNear_m) hardships |= BitOf(kNearFrame);
  if (frame.truth != PatternTruth::kWhole) return hardships;
  if (2 * frame.ring_radius_px < kSmallPx) hardships |= BitOf(kSmallFrame);
  if (frame.visible_fraction < kWhole) hardships |= BitOf(kCutOffFrame);
  return hardships;
}

// Changes the image and chooses a calibration.
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

// True when the print is the frame's pattern; nothing when that cannot be decided.
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

std::vector<ScoredFrame> Search(const TrainingSource& source) {
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
      // All changes of a still are held out, or none of them.
      constexpr std::size_t kOneOf = 5;
      ScoredFrame scored{fmt::format("{}:{}:{}", source.name, i, number),
                         source.hardships | HardshipsOf(frame),
                         source.is_held_out || i % kOneOf == kOneOf - 1,
                         frame.truth == PatternTruth::kWhole,
                         {}};
      const FindingObserver observer = [&](const PrintFinding& print) {
        const std::optional<bool> is_pattern = IsPattern(print, frame);
        if (is_pattern) scored.prints.push_back({print.kind, print.doubts, *is_pattern});
      };
      const TargetHint no_hint;
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

// --- Findings as a file, as rendering takes an hour: one line per frame and one per print. ---

void Write(const std::vector<ScoredFrame>& frames, const std::string& file) {
  auto out = fmt::output_file(file);
  for (const ScoredFrame& frame : frames) {
    out.print("{} {} {} {} {}\n", frame.name, frame.hardships, static_cast<int>(frame.is_held_out),
              static_cast<int>(frame.has_pattern), frame.prints.size());
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
  while (in >> frame.name >> frame.hardships >> frame.is_held_out >> frame.has_pattern >> prints) {
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

std::vector<ScoredFrame> SearchAll(const std::vector<TrainingSource>& sources) {
  std::vector<ScoredFrame> all;
  for (const TrainingSource& source : sources) {
    const std::vector<ScoredFrame> frames = Search(source);
    fmt::print(stderr, "{}: {} frames\n", source.name, frames.size());
    all.insert(all.end(), frames.begin(), frames.end());
  }
  return all;
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

// Prints the calibration of the score by what makes a frame hard to see.
void ReportHardships(const PrintScore& score, const std::vector<ScoredFrame>& frames) {
  fmt::print(
      "\n## By condition, held out\n\n| condition | frames | expected calibration error | found, "
      "of "
      "those with the pattern | false, of those without |\n|---|---|---|---|---|\n");
  const double min_quality = LandingPatternDetectorOptions().min_quality;
  for (unsigned bit = 0; bit < kStillConditions + kFrameHardships.size(); ++bit) {
    std::vector<ScoredFrame> chosen;
    std::copy_if(frames.begin(), frames.end(), std::back_inserter(chosen),
                 [bit](const ScoredFrame& frame) { return frame.hardships >> bit & 1; });
    const DetectionRates rates = MeasureRates(score, chosen, min_quality);
    fmt::print("| {} | {} | {:.3f} | {:.1f} % | {:.2f} % |\n", NameOf(bit), chosen.size(),
               MeasureReliability(score, chosen).expected_calibration_error, 100 * rates.found,
               100 * rates.false_of_all);
  }
}

struct Options {
  std::string output, findings, images;
  double scale = 1;
  bool keeps_small = false;
};

void Run(const Options& options) {
  std::vector<ScoredFrame> frames;
  if (!options.findings.empty() && std::filesystem::exists(options.findings)) {
    frames = Read(options.findings);
  } else {
    frames = SearchAll(StillSources(options.scale, options.images).Take());
    if (!options.findings.empty()) Write(frames, options.findings);
  }
  const auto held_out = std::stable_partition(
      frames.begin(), frames.end(), [](const ScoredFrame& frame) { return !frame.is_held_out; });
  const std::vector<ScoredFrame> tests(held_out, frames.end());
  frames.erase(held_out, frames.end());
  PrintScore score = TrainPrintScore(frames);
  if (options.keeps_small) {
    constexpr auto kSmall = static_cast<std::size_t>(PrintKind::kAsAWhole);
    score[kSmall] = kPrintWeights[kSmall];
  }
  Report("Stills that were trained on", score, frames);
  Report("Held-out stills", score, tests);
  ReportHardships(score, tests);
  Report("Real and hard frames", score, SearchAll(RealFrames()));
  if (!options.output.empty()) fmt::output_file(options.output).print("{}", ToSource(score));
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("Trains the score of prints on seeded stills; an hour or two on two cores.");
  kestrel::Options options;
  app.add_option("--output", options.output, "Header to write, print_score_weights.h");
  app.add_option("--findings", options.findings,
                 "File of findings: read when it is there, else written");
  app.add_option("--images", options.images, "Folder that keeps the rendered stills")
      ->check(CLI::ExistingDirectory);
  app.add_flag("--keep-small", options.keeps_small, "The weights of small prints stay as they are");
  app.add_option("--scale", options.scale, "Share of the stills, of 8,700");
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  return kestrel::ReportMain([&] {
    kestrel::Run(options);
    return 0;
  });
}
