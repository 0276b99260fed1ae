// SPDX-License-Identifier: BSD-3-Clause
// Measures where the landing pattern detector spends its time: Google Benchmark on a few frames,
// the time of its stages over all real frames, and its time by the size of the image. landing_speed
// compares it with known methods.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "apriltag_peer.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "landing_frames.h"
#include "landing_peers.h"
#include "landing_score.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr int kRounds = 9;
constexpr double kHintError_m = 0.05;  // standard deviation per axis

// Frames of one camera and the hints that a tracker would give about each.
struct Scenes {
  std::string name;
  LandingPatternDetector detector;
  std::vector<cv::Mat> images;
  std::vector<TargetHint> hints;  // without a centre if the pattern was not found
};

Scenes MakeScenes(const std::string& name, const CameraIntrinsics& camera,
                  std::vector<cv::Mat> images) {
  Scenes scenes{name, LandingPatternDetector(CameraModel(camera), {}), std::move(images), {}};
  LandingWorkspace workspace;
  Random random(1);
  const auto error = [&random] { return kHintError_m * random.Normal(); };
  for (const cv::Mat& image : scenes.images) {
    const TargetReport report = scenes.detector.Detect(image, {}, workspace);
    TargetHint hint;
    if (report.detection) {
      hint.center_in_camera = report.detection->camera_from_target.translation;
      for (double& coordinate : hint.center_in_camera->array()) coordinate += error();
      hint.center_sigma_m = 3 * kHintError_m;
      hint.up_in_camera = report.detection->camera_from_target.rotation * Eigen::Vector3d::UnitZ();
    }
    scenes.hints.push_back(hint);
  }
  return scenes;
}

// The first stills, with the pattern or with look-alikes; the same for each size.
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

// Four frames with the pattern of each sequence, evenly spaced.
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
      const TargetHint hint = with_hint ? scenes.hints[i] : TargetHint();
      benchmark::DoNotOptimize(scenes.detector.Detect(scenes.images[i], hint, *workspace));
    }
  };
}

Contestant AprilTag(const Scenes& scenes, float decimate) {
  return [&scenes, tags = AprilTagPeer("tag36h11", decimate)] {
    for (const cv::Mat& image : scenes.images) tags.Find(image);
  };
}

Contestant Aruco(const Scenes& scenes) {
  return [&scenes, aruco = ArucoSearch()]() mutable {
    for (const cv::Mat& image : scenes.images) aruco.Search(image);
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
  add("cv::adaptiveThreshold", Threshold(scenes));
  add("Detect, whole frame", Detect(scenes, /*with_hint=*/false));
  add("Detect, with prediction", Detect(scenes, /*with_hint=*/true));
  add("AprilTag 3, decimate 1", AprilTag(scenes, 1));
  add("AprilTag 3, decimate 2", AprilTag(scenes, 2));
  add("ArUco", Aruco(scenes));
}

// --- Stages and size ---

double MillisecondsOf(const std::function<void()>& run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

// Time of each stage, summed over frames.
struct StageTimes {
  std::array<double, kLandingStageCount> ms{};
  int frames = 0;
  void Add(const TargetReport& report) {
    for (int i = 0; i < kLandingStageCount; ++i) ms[i] += 1e-6 * report.diagnostics.stage_ns[i];
    ++frames;
  }
};

// Median time of one frame.
struct FrameTime {
  std::string name;
  double detect_ms;
};

// Processes all frames kRounds times, one round after the other.
std::vector<FrameTime> TimeFrames(const LandingFrameSet& set, StageTimes* stages) {
  const LandingPatternDetector detector(CameraModel(set.camera), {});
  LandingWorkspace workspace;
  std::vector<std::vector<double>> detect_ms(set.frames.size());
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < set.frames.size(); ++i) {
      TargetReport report;
      detect_ms[i].push_back(
          MillisecondsOf([&] { report = detector.Detect(set.frames[i].image, {}, workspace); }));
      stages->Add(report);
    }
  }
  std::vector<FrameTime> times;
  for (std::size_t i = 0; i < set.frames.size(); ++i) {
    times.push_back({set.frames[i].name, Quantile(detect_ms[i], 0.5)});
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

void PrintFrames(const LandingFrameSet& set) {
  StageTimes stages;
  const std::vector<FrameTime> times = TimeFrames(set, &stages);
  fmt::print("\n## {}\n\n{} frames, without a hint\n", set.name, set.frames.size());
  PrintStages(stages);
  PrintSlowest(times);
}

// All real frames, including those without the pattern, camera by camera.
void PrintAllFrames(const std::vector<LandingFrameSet>& real) {
  LandingFrameSet sequences{"All real 640x360 frames", {}, {}};
  for (const LandingFrameSet& set : real) {
    if (!IsSequence(set)) {
      PrintFrames(set);
      continue;
    }
    sequences.camera = set.camera;
    sequences.frames.insert(sequences.frames.end(), set.frames.begin(), set.frames.end());
  }
  if (!sequences.frames.empty()) PrintFrames(sequences);
}

// The paper's camera with another number of pixels.
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
  benchmark::RunSpecifiedBenchmarks();
  PrintAllFrames(real);
  PrintCostBySize();
  return 0;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  return kestrel::ReportMain([&] { return kestrel::Run(argc, argv); });
}
