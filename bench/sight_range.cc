// SPDX-License-Identifier: BSD-3-Clause
// Part of the frames in which a pad is found without a track, by its extent in the image, through
// the paper's lens at full and at half resolution. Usage:
// sight_range [--target KIND] [--family NAME] [--board FILE] [--frames N] [--seed N]
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "for_each_index.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/vision/helipad/test_helipad_images.h"
#include "kestrel/vision/targets/make_target_detector.h"
#include "kestrel/vision/targets/test_pad_search.h"
#include "pad_settings.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr std::array<double, 12> kExtents{8, 10, 12, 14, 16, 18, 20, 23, 26, 30, 35, 40};  // px

// Returns the part of the frames at 'altitude' in which the pad is found at its place.
double FoundAt(const TargetDetector& detector, const TargetPrint& print,
               const PadRenderer& renderer, double altitude, const PadSettings& settings) {
  std::vector<char> found(settings.count);
  ForEachIndex(found.size(), [&](std::size_t i) {
    found[i] = IsFoundFrom(altitude, detector, print, renderer, settings.seed + i);
  });
  return static_cast<double>(std::count(found.begin(), found.end(), 1)) / settings.count;
}

void PrintRange(const CameraModel& camera, const PadSettings& settings) {
  const LandingPatternDetectorOptions ring;
  const auto detector = MakeTargetDetector(camera, settings.target, ring);
  const TargetPrint print = PrintOfTarget(settings.target, ring.pattern);
  const PadRenderer renderer(camera);
  for (const double extent : kExtents) {
    const double altitude = detector->shape().diameter_m * camera.intrinsics().fx_px / extent;
    fmt::print("| {} | {} px | {:.1f} m | {:.0f} px | {:.0f} % |\n", settings.target.kind,
               camera.width_px(), altitude, extent,
               100 * FoundAt(*detector, print, renderer, altitude, settings));
  }
}

void Run(const PadSettings& settings) {
  cv::setNumThreads(1);
  fmt::print("| pad | image | altitude | extent | found |\n|---|---|---|---|---|\n");
  PrintRange(CameraModel(PaperCamera()), settings);
  PrintRange(CameraModel(AtHalfResolution(PaperCamera())), settings);
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("Extent in the image from which a pad is found");
  kestrel::PadSettings settings{.target = {}, .count = 40};
  kestrel::AddOptions(&app, "frames", "Frames for each extent", &settings);
  app.add_option("--family", settings.target.apriltag.family, "Family of an apriltag (tag36h11)");
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] {
    kestrel::Run(settings);
    return 0;
  });
}
