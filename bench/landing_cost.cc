// SPDX-License-Identifier: BSD-3-Clause
// Runs the landing pattern detector once over a set of frames, for scripts/instructions to count
// what it executes, and prints what it found, for scripts/arm64_check to compare.
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "landing_frames.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr int kStills = 24;

// Frames of all sequences or conditions, at even distances, that have the pattern or have none.
std::vector<LandingFrameSet> Choose(std::vector<LandingFrameSet> sets, bool has_pattern,
                                    std::size_t most) {
  std::size_t count = 0;
  for (LandingFrameSet& set : sets) {
    std::erase_if(set.frames, [&](const LandingFrame& frame) {
      return (frame.truth == PatternTruth::kNone) == has_pattern;
    });
    count += set.frames.size();
  }
  const std::size_t step = 1 + count / most;
  std::size_t index = 0;
  for (LandingFrameSet& set : sets) {
    std::erase_if(set.frames, [&](const LandingFrame&) { return index++ % step != 0; });
  }
  return sets;
}

// Stills that are rendered here and now.
LandingFrameSet RenderStills() {
  const LandingStillMaker maker(LandingStillOptions{});
  LandingFrameSet set{"stills", maker.camera().intrinsics(), {}};
  for (int seed = 1; seed <= kStills; ++seed) set.frames.push_back(FrameFromStill(maker, "", seed));
  return set;
}

std::vector<LandingFrameSet> FramesOf(const std::string& name, const std::string& data_dir,
                                      std::size_t most) {
  if (name == "stills") return {RenderStills()};
  return Choose(name == "real" ? ReadLandingReal(data_dir) : ReadLandingHard(data_dir),
                name != "empty", most);
}

// A row of CSV: the frame, a hash (FNV-1a) of its pixels, and the detection.
void Print(const LandingFrame& frame, const TargetReport& report) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const auto pixel : cv::Mat1b(frame.image)) hash = (hash ^ pixel) * 0x100000001b3u;
  fmt::print("{},{:016x}", frame.name, hash);
  if (report.detection) {
    const Eigen::Vector2d& pixel = report.detection->center_px;
    const Eigen::Vector3d& place = report.detection->camera_from_target.translation;
    fmt::print(",{:.6f},{:.6f},{:.7f},{:.7f},{:.7f},{:.5f}", pixel.x(), pixel.y(), place.x(),
               place.y(), place.z(), report.detection->quality);
  }
  fmt::print("\n");
}

// Returns a hint at the pattern's last place, the least that a track gives.
TargetHint HintOf(const TargetDetection& detection) {
  TargetHint hint;
  hint.center_in_camera = detection.camera_from_target.translation;
  hint.center_sigma_m = 0.1;
  return hint;
}

int Run(int argc, char** argv) {
  CLI::App app{"Runs the landing pattern detector once over a set of frames"};
  std::string data_dir = KESTREL_DATA_DIR;
  std::string name = "real";
  std::size_t most = 30;
  bool is_printed = false, is_near = false;
  app.add_option("--data", data_dir, "folder with landing_real and landing_hard");
  app.add_option("--set", name, "real, hard, empty (of hard) or stills, which are rendered")
      ->check(CLI::IsMember({"real", "hard", "empty", "stills"}));
  app.add_option("--most", most, "about so many frames of the set")->check(CLI::Range(1, 10000));
  app.add_flag("--print", is_printed, "print the detections, not the number of frames");
  app.add_flag("--near", is_near, "detect once more, near the place where the pattern was found");
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  std::size_t frames = 0;
  for (const LandingFrameSet& set : FramesOf(name, data_dir, most)) {
    const LandingPatternDetector detector(CameraModel(set.camera), {});
    LandingWorkspace workspace;
    for (const LandingFrame& frame : set.frames) {
      const TargetReport report = detector.Detect(frame.image, {}, workspace);
      if (is_printed) Print(frame, report);
      if (is_near && report.detection) {
        detector.Detect(frame.image, HintOf(*report.detection), workspace);
      }
    }
    frames += set.frames.size();
  }
  if (frames == 0) throw InputError(data_dir + ": has no frames of the set " + name);
  if (!is_printed) fmt::print("{}\n", frames);
  return 0;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  return kestrel::ReportMain([&] { return kestrel::Run(argc, argv); });
}
