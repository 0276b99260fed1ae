// SPDX-License-Identifier: BSD-3-Clause
// Speed of the landing pattern detector in one table with known methods on the same frames: one
// adaptive threshold, AprilTag 3 and ArUco. They alternate, pass by pass, so that noise affects all
// alike. Times are processor times of one thread; a frame's time is its median over the passes.
#include <algorithm>
#include <ctime>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "apriltag_peer.h"
#include "for_each_index.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "landing_frames.h"
#include "landing_peers.h"
#include "landing_score.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr double kHintError_m = 0.05;  // standard deviation per axis
constexpr int kMinCallsPerPass = 50;   // a set of few frames is repeated

// Largest wanted ratios of times, if any.
struct Wanted {
  std::optional<double> median_per_threshold = {};
  std::optional<double> p99_per_tag_median = {};
  std::optional<double> p99_per_median = {};
};

struct SpeedSet {
  LandingFrameSet frames;
  Wanted whole_frame;  // for Detect without a prediction,
  Wanted predicted;    // and with one
};

// --- Frames ---

LandingFrameSet RenderedLookalikes() {
  constexpr int kCount = 100;
  const LandingStillMaker maker({});
  LandingFrameSet set{"look-alikes, rendered, 752x480", maker.options().camera, {}};
  set.frames.resize(kCount);
  ForEachIndex(kCount, 2, [&](std::size_t seed) {
    set.frames[seed] = FrameFromLookalikes(maker, set.name, seed);
  });
  return set;
}

// The frames of 'sets', which have one camera, for which 'is_wanted' is true.
LandingFrameSet Join(const std::string& name, const std::vector<LandingFrameSet>& sets,
                     const std::function<bool(const LandingFrame&)>& is_wanted) {
  LandingFrameSet joined{name, sets.front().camera, {}};
  for (const LandingFrameSet& set : sets) {
    std::copy_if(set.frames.begin(), set.frames.end(), std::back_inserter(joined.frames),
                 is_wanted);
  }
  return joined;
}

std::vector<SpeedSet> MakeSets(const std::string& data_dir) {
  std::vector<SpeedSet> sets;
  std::vector<LandingFrameSet> real = ReadLandingReal(data_dir);
  const auto sequences =
      std::stable_partition(real.begin(), real.end(), [](const LandingFrameSet& set) {
        return set.frames.size() == 1;  // from the fisheye camera
      });
  const auto every = [](const LandingFrame&) { return true; };
  if (sequences != real.begin()) {
    sets.push_back({Join("fisheye, real, 752x480", {real.begin(), sequences}, every),
                    {.median_per_threshold = 0.25},
                    {.median_per_threshold = 0.12}});
  }
  if (sequences != real.end()) {
    sets.push_back({Join("sequences, real, 640x360", {sequences, real.end()}, every),
                    {.median_per_threshold = 0.8, .p99_per_median = 4},
                    {.median_per_threshold = 0.25}});
  }
  const Wanted without_pattern{.p99_per_tag_median = 1};
  sets.push_back({RenderedLookalikes(), without_pattern, {}});
  const std::vector<LandingFrameSet> hard = ReadLandingHard(data_dir);
  if (!hard.empty()) {
    const auto is_empty = [](const LandingFrame& f) { return f.truth == PatternTruth::kNone; };
    sets.push_back(
        {Join("landing_hard without the pattern, 752x480", hard, is_empty), without_pattern, {}});
  }
  return sets;
}

// The hint of a tracker for a frame with this detection.
TargetHint Predict(const TargetDetection& detection, Random* random) {
  TargetHint hint;
  hint.center_in_camera = detection.camera_from_target.translation;
  for (double& coordinate : hint.center_in_camera->array()) {
    coordinate += kHintError_m * random->Normal();
  }
  hint.center_sigma_m = 3 * kHintError_m;
  hint.up_in_camera = detection.camera_from_target.rotation * Eigen::Vector3d::UnitZ();
  return hint;
}

// --- Contestants and their times ---

struct Contestant {
  std::string name;
  std::function<void(std::size_t frame)> run;
  Wanted wanted = {};
  std::vector<std::size_t> frames = {};            // indices of the frames that it runs on
  std::vector<std::vector<double>> times_ms = {};  // for each of these frames
};

double ProcessorMs() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

void RunOverFrames(Contestant* contestant) {
  for (std::size_t i = 0; i < contestant->frames.size(); ++i) {
    const double start = ProcessorMs();
    contestant->run(contestant->frames[i]);
    contestant->times_ms[i].push_back(ProcessorMs() - start);
  }
}

void RunPasses(int passes, std::vector<Contestant>* contestants) {
  for (int pass = 0; pass < passes; ++pass) {
    for (Contestant& contestant : *contestants) {
      contestant.times_ms.resize(contestant.frames.size());
      if (contestant.frames.empty()) continue;
      for (std::size_t calls = 0; calls < kMinCallsPerPass; calls += contestant.frames.size()) {
        RunOverFrames(&contestant);
      }
    }
  }
}

// The quantile 'p' of the contestant's frame times.
double FrameMs(const Contestant& contestant, double p) {
  std::vector<double> medians_ms;
  for (const std::vector<double>& times_ms : contestant.times_ms) {
    medians_ms.push_back(Quantile(times_ms, 0.5));
  }
  return Quantile(medians_ms, p);
}

// --- The table ---

std::string Verdict(const char* what, double ratio, std::optional<double> bound) {
  if (!bound) return "";
  return fmt::format("{} <= {} {} ", what, *bound, ratio <= *bound ? "pass" : "**FAIL**");
}

void PrintHeader() {
  fmt::print(
      "| frames | contestant | number | median, ms | 99 %, ms | median / threshold | "
      "99 % / AprilTag's median | 99 % / median | wanted |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
}

void PrintRow(const std::string& set, const Contestant& contestant, double threshold_ms,
              double tag_ms) {
  const double median_ms = FrameMs(contestant, 0.5);
  const double p99_ms = FrameMs(contestant, 0.99);
  const double per_threshold = median_ms / threshold_ms;
  const double per_tag = p99_ms / tag_ms;
  const double per_median = p99_ms / median_ms;
  const Wanted& wanted = contestant.wanted;
  fmt::print("| {} | {} | {} | {:.3f} | {:.3f} | {:.2f} | {:.2f} | {:.2f} | {}{}{}|\n", set,
             contestant.name, contestant.frames.size(), median_ms, p99_ms, per_threshold, per_tag,
             per_median, Verdict("median / threshold", per_threshold, wanted.median_per_threshold),
             Verdict("99 % / AprilTag's median", per_tag, wanted.p99_per_tag_median),
             Verdict("99 % / median", per_median, wanted.p99_per_median));
}

void Measure(const SpeedSet& set, int passes) {
  const std::vector<LandingFrame>& frames = set.frames.frames;
  const LandingPatternDetector detector(CameraModel(set.frames.camera), {});
  LandingWorkspace workspace;
  std::vector<std::size_t> all, predicted;
  std::vector<TargetHint> hints(frames.size());
  Random random(1);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    all.push_back(i);
    if (frames[i].truth == PatternTruth::kNone) continue;
    const TargetReport report = detector.Detect(frames[i].image, {}, workspace);
    if (!report.detection) continue;
    hints[i] = Predict(*report.detection, &random);
    predicted.push_back(i);
  }

  cv::Mat binary;
  const AprilTagPeer tags("tag36h11", 2);
  ArucoSearch aruco;
  const auto threshold = [&](std::size_t i) { ThresholdImage(frames[i].image, &binary); };
  const auto detect = [&](std::size_t i) { detector.Detect(frames[i].image, {}, workspace); };
  const auto predict = [&](std::size_t i) {
    detector.Detect(frames[i].image, hints[i], workspace);
  };
  std::vector<Contestant> contestants{
      {"cv::adaptiveThreshold", threshold, {}, all},
      {"AprilTag 3, decimate 2", [&](std::size_t i) { tags.Find(frames[i].image); }, {}, all},
      {"ArUco", [&](std::size_t i) { aruco.Search(frames[i].image); }, {}, all},
      {"Detect, whole frame", detect, set.whole_frame, all},
      {"Detect, with prediction", predict, set.predicted, predicted},
  };
  RunPasses(passes, &contestants);
  const double threshold_ms = FrameMs(contestants[0], 0.5);
  const double tag_ms = FrameMs(contestants[1], 0.5);
  for (const Contestant& contestant : contestants) {
    if (contestant.frames.empty()) continue;
    PrintRow(set.frames.name, contestant, threshold_ms, tag_ms);
  }
}

int Run(int argc, char** argv) {
  CLI::App app{"Speed of the landing pattern detector beside known work on the same frames"};
  std::string data_dir = KESTREL_DATA_DIR;
  int passes = 5;
  app.add_option("--data", data_dir, "folder with landing_real and landing_hard");
  app.add_option("--passes", passes, "over the frames")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  PrintHeader();
  for (const SpeedSet& set : MakeSets(data_dir)) Measure(set, passes);
  return 0;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  return kestrel::ReportMain([&] { return kestrel::Run(argc, argv); });
}
