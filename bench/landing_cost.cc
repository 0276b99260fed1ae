// SPDX-License-Identifier: BSD-3-Clause
// Runs the landing pattern detector once over a set of frames, for scripts/instructions to count
// what it executes.
#include <cstddef>
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

constexpr std::size_t kMostFrames = 30;  // of a set

// Frames of all sequences or conditions, at even distances, that have the pattern or have none.
std::vector<LandingFrameSet> Choose(std::vector<LandingFrameSet> sets, bool has_pattern) {
  std::size_t count = 0;
  for (LandingFrameSet& set : sets) {
    std::erase_if(set.frames, [&](const LandingFrame& frame) {
      return (frame.truth == PatternTruth::kNone) == has_pattern;
    });
    count += set.frames.size();
  }
  const std::size_t step = 1 + count / kMostFrames;
  std::size_t index = 0;
  for (LandingFrameSet& set : sets) {
    std::erase_if(set.frames, [&](const LandingFrame&) { return index++ % step != 0; });
  }
  return sets;
}

int Run(int argc, char** argv) {
  CLI::App app{"Runs the landing pattern detector once over a set of frames"};
  std::string data_dir = KESTREL_DATA_DIR;
  std::string name = "real";
  app.add_option("--data", data_dir, "folder with landing_real and landing_hard");
  app.add_option("--set", name, "real, hard or empty")
      ->check(CLI::IsMember({"real", "hard", "empty"}));
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  const bool is_real = name == "real";
  const std::vector<LandingFrameSet> sets =
      Choose(is_real ? ReadLandingReal(data_dir) : ReadLandingHard(data_dir), name != "empty");
  std::size_t frames = 0;
  for (const LandingFrameSet& set : sets) {
    const LandingPatternDetector detector(CameraModel(set.camera), {});
    LandingWorkspace workspace;
    for (const LandingFrame& frame : set.frames) detector.Detect(frame.image, {}, workspace);
    frames += set.frames.size();
  }
  if (frames == 0) throw InputError(data_dir + ": has no frames of the set " + name);
  fmt::print("{}\n", frames);
  return 0;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  return kestrel::ReportMain([&] { return kestrel::Run(argc, argv); });
}
