// SPDX-License-Identifier: BSD-3-Clause
// Speed of the landing pattern detector beside what is known: one adaptive threshold, AprilTag 3
// and ArUco on the same frames, on one thread, each in turn so that noise hits all alike. Then its
// spread over all real frames, the time of its stages and its cost against the size of the image.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include "kestrel/base/random.h"
#include "kestrel/camera/paper_camera.h"
#include "kestrel/landing/landing_pattern_detector.h"
#include "landing_frames.h"
#include "landing_score.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr int kRounds = 9;
constexpr char kThreshold[] = "cv::adaptiveThreshold, mean, box 11";
constexpr char kDetect[] = "Detect, whole frame";
constexpr char kDetectHint[] = "Detect, hint 0.05 m off and up";
constexpr double kHintError_m = 0.05;  // standard deviation per axis

// Frames of one camera and what a tracker would tell the detector about each.
struct Scenes {
  std::string name;
  LandingPatternDetector detector;
  std::vector<cv::Mat> images;
  std::vector<LandingHint> hints;  // without a centre where the pattern was not found
};

Scenes MakeScenes(const std::string& name, const CameraIntrinsics& camera,
                  std::vector<cv::Mat> images) {
  Scenes scenes{name, LandingPatternDetector(CameraModel(camera), {}), std::move(images), {}};
  LandingWorkspace workspace;
  Random random(1);
  const auto error = [&random] { return kHintError_m * random.Normal(); };
  for (const cv::Mat& image : scenes.images) {
    const LandingReport report = scenes.detector.Detect(image, {}, workspace);
    LandingHint hint;
    if (report.detection) {
      hint.center_in_camera = report.detection->camera_from_pattern.translation;
      for (double& coordinate : hint.center_in_camera->array()) coordinate += error();
      hint.center_sigma_m = 3 * kHintError_m;
      hint.up_in_camera = report.detection->camera_from_pattern.rotation * Eigen::Vector3d::UnitZ();
    }
    scenes.hints.push_back(hint);
  }
  return scenes;
}

// The first stills, with the pattern or with look-alikes; the same at every size.
std::vector<cv::Mat> RenderedImages(const CameraIntrinsics& camera, int count, bool lookalikes) {
  LandingStillOptions options;
  options.camera = camera;
  const LandingStillMaker maker(options);
  std::vector<cv::Mat> images;
  for (int seed = 0; seed < count; ++seed) {
    images.push_back(lookalikes ? maker.MakeLookalikes(seed).image : maker.MakePattern(seed).image);
  }
  return images;
}

bool IsSequence(const LandingFrameSet& set) { return set.frames.size() > 1; }

// Four frames with the pattern of each sequence, evenly spread.
std::vector<cv::Mat> SampleSequences(const std::vector<LandingFrameSet>& real) {
  constexpr std::size_t kPerSequence = 4;
  std::vector<cv::Mat> images;
  for (const LandingFrameSet& set : real) {
    if (!IsSequence(set)) continue;
    std::vector<cv::Mat> whole;
    for (const LandingFrame& frame : set.frames) {
      if (frame.truth == PatternTruth::kWhole) whole.push_back(frame.image);
    }
    for (std::size_t i = 0; i < kPerSequence; ++i) {
      images.push_back(whole[i * (whole.size() - 1) / (kPerSequence - 1)]);
    }
  }
  return images;
}

std::vector<Scenes> MakeAllScenes(const std::vector<LandingFrameSet>& real) {
  std::vector<Scenes> all;
  const auto still = std::find_if(real.begin(), real.end(),
                                  [](const LandingFrameSet& set) { return !IsSequence(set); });
  if (still != real.end()) {
    all.push_back(MakeScenes("fisheye 752x480", still->camera, {still->frames.front().image}));
  } else {
    all.push_back(MakeScenes("rendered 752x480", PaperCamera(),
                             RenderedImages(PaperCamera(), 1, /*lookalikes=*/false)));
  }
  const auto sequence = std::find_if(real.begin(), real.end(), IsSequence);
  if (sequence != real.end()) {
    all.push_back(MakeScenes("real 640x360", sequence->camera, SampleSequences(real)));
  }
  return all;
}

void ThresholdImage(const cv::Mat& image, cv::Mat* binary) {
  constexpr int kBox = 11;
  cv::adaptiveThreshold(image, *binary, 255, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY_INV,
                        kBox, 5);
}

// --- The contestants: each goes once over the images of a scene. ---

using Contestant = std::function<void()>;

Contestant Threshold(const Scenes& scenes) {
  return [&scenes, binary = cv::Mat()]() mutable {
    for (const cv::Mat& image : scenes.images) {
      ThresholdImage(image, &binary);
    }
  };
}

Contestant Detect(const Scenes& scenes, bool with_hint) {
  return [&scenes, with_hint, workspace = std::make_shared<LandingWorkspace>()] {
    for (std::size_t i = 0; i < scenes.images.size(); ++i) {
      const LandingHint hint = with_hint ? scenes.hints[i] : LandingHint();
      benchmark::DoNotOptimize(scenes.detector.Detect(scenes.images[i], hint, *workspace));
    }
  };
}

// AprilTag 3 on one thread.
class AprilTagSearch {
 public:
  explicit AprilTagSearch(float decimate) : family_(tag36h11_create(), tag36h11_destroy) {
    apriltag_detector_add_family(detector_.get(), family_.get());
    detector_->nthreads = 1;
    detector_->quad_decimate = decimate;
  }

  void Search(const cv::Mat& image) const {
    image_u8_t view = {.width = image.cols,
                       .height = image.rows,
                       .stride = static_cast<int>(image.step[0]),
                       .buf = image.data};
    apriltag_detections_destroy(apriltag_detector_detect(detector_.get(), &view));
  }

 private:
  // The detector refers to the family, which must outlive it.
  std::shared_ptr<apriltag_family_t> family_;
  std::shared_ptr<apriltag_detector_t> detector_{apriltag_detector_create(),
                                                 apriltag_detector_destroy};
};

Contestant AprilTag(const Scenes& scenes, float decimate) {
  return [&scenes, tags = AprilTagSearch(decimate)] {
    for (const cv::Mat& image : scenes.images) tags.Search(image);
  };
}

Contestant Aruco(const Scenes& scenes) {
  return [&scenes,
          dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_6X6_250)]() mutable {
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
    for (const cv::Mat& image : scenes.images) {
      cv::aruco::detectMarkers(image, dictionary, corners, ids);
    }
  };
}

void Register(const Scenes& scenes) {
  const auto add = [&](const std::string& name, const Contestant& run) {
    benchmark::RegisterBenchmark(
        (scenes.name + "/" + name).c_str(),
        [&scenes, run](benchmark::State& state) {
          for (auto _ : state) run();
          state.SetItemsProcessed(state.iterations() * std::ssize(scenes.images));
        })
        ->Repetitions(kRounds)
        ->MinTime(0.1)
        ->Unit(benchmark::kMillisecond);
  };
  add(kThreshold, Threshold(scenes));
  add(kDetect, Detect(scenes, /*with_hint=*/false));
  add(kDetectHint, Detect(scenes, /*with_hint=*/true));
  add("AprilTag 3, decimate 1", AprilTag(scenes, 1));
  add("AprilTag 3, decimate 2", AprilTag(scenes, 2));
  add("ArUco", Aruco(scenes));
}

// Remembers the medians (processor time per iteration, ms) for the table.
class MedianReporter : public benchmark::ConsoleReporter {
 public:
  MedianReporter() : ConsoleReporter(OO_None) {}
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.aggregate_name == "median") {
        medians_ms_[run.run_name.function_name] = run.GetAdjustedCPUTime();
      }
    }
  }
  // Nothing when the benchmark was filtered out.
  const double* MedianMs(const std::string& name) const {
    const auto median = medians_ms_.find(name);
    return median == medians_ms_.end() ? nullptr : &median->second;
  }
  const std::map<std::string, double>& medians_ms() const { return medians_ms_; }

 private:
  std::map<std::string, double> medians_ms_;
};

const char* Verdict(bool holds) { return holds ? "pass" : "**FAIL**"; }

std::string WantedRatio(const std::string& contestant, double ratio) {
  if (contestant == kDetect) return fmt::format("<= 1.5 {}", Verdict(ratio <= 1.5));
  if (contestant == kDetectHint) return fmt::format("<= 0.4 {}", Verdict(ratio <= 0.4));
  return "";
}

void PrintContest(const std::vector<Scenes>& all, const MedianReporter& reporter) {
  fmt::print(
      "\n| frames | contestant | ms per frame | over adaptiveThreshold | wanted "
      "|\n|---|---|---|---|---|\n");
  for (const Scenes& scenes : all) {
    const double* threshold = reporter.MedianMs(scenes.name + "/" + kThreshold);
    for (const auto& [name, median] : reporter.medians_ms()) {
      if (threshold == nullptr || !name.starts_with(scenes.name + "/")) continue;
      const std::string contestant = name.substr(scenes.name.size() + 1);
      const double ratio = median / *threshold;
      fmt::print("| {} | {} | {:.3f} | {:.2f} | {} |\n", scenes.name, contestant,
                 median / static_cast<double>(scenes.images.size()), ratio,
                 WantedRatio(contestant, ratio));
    }
    const auto lost = std::count_if(scenes.hints.begin(), scenes.hints.end(),
                                    [](const LandingHint& h) { return !h.center_in_camera; });
    if (lost > 0) fmt::print("\n{}: {} frames have no hint, not found.\n\n", scenes.name, lost);
  }
}

// --- Spread, stages and size ---

double MillisecondsOf(const std::function<void()>& run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

// Time per stage, summed up over frames.
struct StageTimes {
  std::array<double, kLandingStageCount> ms{};
  int frames = 0;
  void Add(const LandingReport& report) {
    for (int i = 0; i < kLandingStageCount; ++i) ms[i] += 1e-6 * report.stage_ns[i];
    ++frames;
  }
};

// Median times of one frame.
struct FrameTime {
  std::string name;
  double detect_ms;
  double threshold_ms;
};

// Goes over all frames kRounds times, round after round.
std::vector<FrameTime> TimeFrames(const LandingFrameSet& set, StageTimes* stages) {
  const LandingPatternDetector detector(CameraModel(set.camera), {});
  LandingWorkspace workspace;
  cv::Mat binary;
  const std::size_t count = set.frames.size();
  std::vector<std::vector<double>> detect_ms(count), threshold_ms(count);
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < count; ++i) {
      const cv::Mat& image = set.frames[i].image;
      LandingReport report;
      detect_ms[i].push_back(
          MillisecondsOf([&] { report = detector.Detect(image, {}, workspace); }));
      threshold_ms[i].push_back(MillisecondsOf([&] { ThresholdImage(image, &binary); }));
      stages->Add(report);
    }
  }
  std::vector<FrameTime> times;
  for (std::size_t i = 0; i < count; ++i) {
    times.push_back(
        {set.frames[i].name, Quantile(detect_ms[i], 0.5), Quantile(threshold_ms[i], 0.5)});
  }
  return times;
}

void PrintStages(const StageTimes& stages) {
  fmt::print("\n| stage | ms per frame, mean |\n|---|---|\n");
  for (int i = 0; i < kLandingStageCount; ++i) {
    fmt::print("| {} | {:.4f} |\n", ToString(static_cast<LandingStage>(i)),
               stages.ms[i] / stages.frames);
  }
}

void PrintSlowest(std::vector<FrameTime> times) {
  constexpr std::size_t kCount = 5;
  std::sort(times.begin(), times.end(),
            [](const FrameTime& a, const FrameTime& b) { return a.detect_ms > b.detect_ms; });
  times.resize(std::min(times.size(), kCount));
  fmt::print("\n| slowest | ms |\n|---|---|\n");
  for (const FrameTime& time : times) fmt::print("| {} | {:.2f} |\n", time.name, time.detect_ms);
}

void PrintSpread(const LandingFrameSet& set) {
  StageTimes stages;
  const std::vector<FrameTime> times = TimeFrames(set, &stages);
  std::vector<double> detect_ms, threshold_ms;
  for (const FrameTime& time : times) {
    detect_ms.push_back(time.detect_ms);
    threshold_ms.push_back(time.threshold_ms);
  }
  const double median = Quantile(detect_ms, 0.5);
  const double p99 = Quantile(detect_ms, 0.99);
  const double ratio = median / Quantile(threshold_ms, 0.5);
  fmt::print(
      "\n## {}\n\n{} frames, without a hint: median {:.3f} ms, that is {:.2f} adaptiveThreshold, "
      "wanted <= 1.5 {}; 99 % {:.3f} ms, {:.2f} medians, wanted <= 4 {}; mean {:.3f} ms\n",
      set.name, times.size(), median, ratio, Verdict(ratio <= 1.5), p99, p99 / median,
      Verdict(p99 <= 4 * median), Mean(detect_ms));
  PrintStages(stages);
  PrintSlowest(times);
}

// --- Frames without the pattern: the whole image is searched by every pass. ---

LandingFrameSet LookalikeFrames() {
  constexpr int kCount = 100;
  LandingStillOptions options;
  options.camera = PaperCamera();
  const LandingStillMaker maker(options);
  LandingFrameSet set{"rendered look-alikes 752x480", options.camera, {}};
  for (int seed = 0; seed < kCount; ++seed) {
    set.frames.push_back(FrameFromLookalikes(maker, set.name, seed));
  }
  return set;
}

// The frames of all sets that have no pattern; the sets are of one camera.
LandingFrameSet WithoutPattern(const std::string& name, const std::vector<LandingFrameSet>& sets) {
  LandingFrameSet without{name, sets.front().camera, {}};
  for (const LandingFrameSet& set : sets) {
    std::copy_if(set.frames.begin(), set.frames.end(), std::back_inserter(without.frames),
                 [](const LandingFrame& frame) { return frame.truth == PatternTruth::kNone; });
  }
  return without;
}

// A row: each frame's time is its median over the rounds.
void PrintSearchTime(const LandingFrameSet& set) {
  const LandingPatternDetector detector(CameraModel(set.camera), {});
  LandingWorkspace workspace;
  const AprilTagSearch tags(2);
  std::vector<double> detect_ms, tags_ms;
  for (const LandingFrame& frame : set.frames) {
    std::vector<double> ours_ms, theirs_ms;
    for (int round = 0; round < kRounds; ++round) {
      ours_ms.push_back(MillisecondsOf([&] { detector.Detect(frame.image, {}, workspace); }));
      theirs_ms.push_back(MillisecondsOf([&] { tags.Search(frame.image); }));
    }
    detect_ms.push_back(Quantile(ours_ms, 0.5));
    tags_ms.push_back(Quantile(theirs_ms, 0.5));
  }
  const double p99 = Quantile(detect_ms, 0.99);
  const double wanted = Quantile(tags_ms, 0.5);
  fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | p99 <= {:.2f} {} |\n", set.name,
             set.frames.size(), Quantile(detect_ms, 0.5), p99, wanted, Quantile(tags_ms, 0.99),
             wanted, Verdict(p99 <= wanted));
}

void PrintSearchTimes(const std::string& data_dir) {
  fmt::print(
      "\n## Frames without the pattern\n\n| frames | number | Detect, median ms | p99 | AprilTag "
      "3, decimate 2, median ms | p99 | wanted |\n|---|---|---|---|---|---|---|\n");
  PrintSearchTime(LookalikeFrames());
  const std::vector<LandingFrameSet> hard = ReadLandingHard(data_dir);
  if (!hard.empty()) PrintSearchTime(WithoutPattern("landing_hard, none in it", hard));
}

// The real frames camera by camera, those without the pattern too.
void PrintSpreads(const std::vector<LandingFrameSet>& real) {
  LandingFrameSet sequences{"All real 640x360 frames", {}, {}};
  for (const LandingFrameSet& set : real) {
    if (!IsSequence(set)) {
      PrintSpread(set);
      continue;
    }
    sequences.camera = set.camera;
    sequences.frames.insert(sequences.frames.end(), set.frames.begin(), set.frames.end());
  }
  if (!sequences.frames.empty()) PrintSpread(sequences);
}

// The paper's camera with other pixels.
CameraIntrinsics CameraOfSize(double megapixels) {
  CameraIntrinsics camera = PaperCamera();
  const double scale = std::sqrt(1e6 * megapixels / (camera.width_px * camera.height_px));
  camera.width_px = static_cast<int>(std::lround(scale * camera.width_px));
  camera.height_px = static_cast<int>(std::lround(scale * camera.height_px));
  camera.fx_px *= scale;
  camera.fy_px *= scale;
  camera.cx_px = (camera.cx_px + 0.5) * scale - 0.5;
  camera.cy_px = (camera.cy_px + 0.5) * scale - 0.5;
  return camera;
}

void PrintCostBySize() {
  constexpr int kScenes = 8;
  fmt::print(
      "\n## Cost against size\n\n{} rendered scenes with the pattern and {} with look-alikes, the "
      "same at every size.\n\n| MP | image | Detect, ms | ms/MP | look-alikes, ms | ms/MP | "
      "adaptiveThreshold, ms/MP |\n|---|---|---|---|---|---|---|\n",
      kScenes, kScenes);
  for (const double megapixels : {0.3, 0.75, 1.5, 3.0, 6.0, 12.0}) {
    const CameraIntrinsics camera = CameraOfSize(megapixels);
    const Scenes patterns =
        MakeScenes("", camera, RenderedImages(camera, kScenes, /*lookalikes=*/false));
    const Scenes lookalikes =
        MakeScenes("", camera, RenderedImages(camera, kScenes, /*lookalikes=*/true));
    const std::array<Contestant, 3> contestants{Detect(patterns, /*with_hint=*/false),
                                                Detect(lookalikes, /*with_hint=*/false),
                                                Threshold(patterns)};
    std::array<std::vector<double>, 3> times_ms;
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t i = 0; i < contestants.size(); ++i) {
        times_ms[i].push_back(MillisecondsOf(contestants[i]) / kScenes);
      }
    }
    const double detect = Quantile(times_ms[0], 0.5);
    const double without = Quantile(times_ms[1], 0.5);
    fmt::print("| {} | {}x{} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", megapixels,
               camera.width_px, camera.height_px, detect, detect / megapixels, without,
               without / megapixels, Quantile(times_ms[2], 0.5) / megapixels);
  }
}

int Run(int argc, char** argv) {
  CLI::App app{"Speed of the landing pattern detector; takes Google Benchmark's options as well"};
  std::string data_dir = KESTREL_DATA_DIR;
  app.add_option("--data", data_dir, "folder with landing_real");
  app.allow_extras();
  CLI11_PARSE(app, argc, argv);
  std::vector<std::string> arguments = app.remaining();
  arguments.insert(arguments.begin(), {argv[0], "--benchmark_enable_random_interleaving=true",
                                       "--benchmark_report_aggregates_only=true"});
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  int count = static_cast<int>(pointers.size());
  benchmark::Initialize(&count, pointers.data());
  if (benchmark::ReportUnrecognizedArguments(count, pointers.data())) return 2;

  cv::setNumThreads(1);
  const std::vector<LandingFrameSet> real = ReadLandingReal(data_dir);
  if (real.empty()) fmt::print("there is no {}/landing_real: rendered frames only\n", data_dir);
  const std::vector<Scenes> scenes = MakeAllScenes(real);
  for (const Scenes& s : scenes) Register(s);
  MedianReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  PrintContest(scenes, reporter);
  PrintSpreads(real);
  PrintSearchTimes(data_dir);
  PrintCostBySize();
  return 0;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  return kestrel::ReportMain([&] { return kestrel::Run(argc, argv); });
}
