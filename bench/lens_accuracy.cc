// SPDX-License-Identifier: BSD-3-Clause
// Prints how well `kestrel calibrate lens` estimates lenses: for rendered views the error against
// the true lens; for each of the real sequences the result, and how much of the pattern is found
// with it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/core.hpp>

#include "for_each_index.h"
#include "kestrel/calibration/lens/lens_calibration.h"
#include "kestrel/calibration/lens/lens_difference.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/io/recording/euroc/euroc_text.h"
#include "kestrel/simulation/labelled_images/landing_stills.h"
#include "landing_frames.h"
#include "landing_score.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr int kThreads = 2;
constexpr double kMaxAngle = Radians(80);  // limit for the comparison of lenses

struct Options {
  std::string data_dir = KESTREL_DATA_DIR;
  int views = 60;
  int seeds = 3;
};

struct RenderedLens {
  const char* name;
  CameraIntrinsics camera;
};

std::vector<RenderedLens> RenderedLenses() {
  const CameraIntrinsics wide{
      752, 480, 430, 430, 370, 246, DistortionModel::kRadialTangential, {-0.3, 0.1, 4e-4, -2e-4}};
  const CameraIntrinsics pinhole{640, 480, 320, 320, 325, 236, DistortionModel::kNone, {}};
  return {{"fisheye of the paper", PaperCamera()},
          {"wide angle with a barrel distortion", wide},
          {"pinhole, 90 degrees", pinhole}};
}

std::vector<LensImage> RenderViews(const CameraIntrinsics& camera, int count, int set) {
  LandingStillOptions options;
  options.camera = camera;
  options.min_altitude_m = 0.7;
  options.max_altitude_m = 2.2;
  options.max_tilt_deg = 50;
  const LandingStillMaker maker(options);
  std::vector<LensImage> images(static_cast<std::size_t>(count));
  ForEachIndex(images.size(), kThreads, [&](std::size_t i) {
    const std::uint64_t seed = 7'000'000 + 1000 * static_cast<std::uint64_t>(set) + i;
    images[i] = {fmt::format("seed {}", seed), maker.MakePattern(seed).image};
  });
  return images;
}

std::string FocalCells(const LensCalibration& lens, double truth_px) {
  return fmt::format("{:.2f} +- {:.2f} | {:+.2f} %", lens.intrinsics.fx_px, lens.fit.sigmas(kFocal),
                     100 * (lens.intrinsics.fx_px / truth_px - 1));
}

std::vector<LensImage> ImagesOf(const std::vector<LandingFrameSet>& sets) {
  std::vector<LensImage> images;
  for (const LandingFrameSet& set : sets) {
    for (const LandingFrame& frame : set.frames) images.push_back({frame.name, frame.image});
  }
  return images;
}

void ReportAgainstTruth(const std::string& name, const CameraIntrinsics& truth,
                        const std::vector<LensImage>& images) {
  try {
    const LensCalibration lens = CalibrateLens(images, {});
    const std::vector<double> differences =
        LensDifferencePx(CameraModel(truth), CameraModel(lens.intrinsics), kMaxAngle);
    fmt::print("| {} | {} of {} | {}, {} | {} | {:.3f} | {:.3f} | {:.3f} |\n", name,
               lens.views.size(), images.size(), DistortionName(lens.intrinsics.distortion_model),
               lens.fit.freedom.distortion, FocalCells(lens, truth.fx_px),
               lens.fit.RootMeanSquare(), Quantile(differences, 0.5), Quantile(differences, 0.95));
  } catch (const InputError& refusal) {
    fmt::print("| {} | of {} | {} | | | | | |\n", name, images.size(), refusal.what());
  }
  std::fflush(stdout);
}

void ReportRendered(const Options& options) {
  fmt::print(
      "## Rendered views\n\n{} views each, tilt to 50 degrees, 0.7 to 2.2 m. Difference: of the "
      "directions of all pixels.\n\n| lens | views used | distortion | focal length, px | error | "
      "residual, px | difference median, px | 95 %, px |\n|---|---|---|---|---|---|---|---|\n",
      options.views);
  for (const RenderedLens& rendered : RenderedLenses()) {
    for (int set = 0; set < options.seeds; ++set) {
      ReportAgainstTruth(rendered.name, rendered.camera,
                         RenderViews(rendered.camera, options.views, set));
    }
  }
  // Each set has another lens.
  for (const LandingFrameSet& set : ReadLandingHard(options.data_dir)) {
    ReportAgainstTruth("another renderer, " + set.name, set.camera, ImagesOf({set}));
  }
}

// Fits the focal length to some views; the rest of the lens is fixed.
std::optional<LensFit> FitFocal(const std::vector<LensView>& views,
                                const CameraIntrinsics& camera) {
  if (views.empty()) return std::nullopt;
  CameraIntrinsics padded = camera;
  padded.distortion.resize(5);
  if (camera.distortion_model == DistortionModel::kNone) {
    padded.distortion_model = DistortionModel::kRadialTangential;
  }
  constexpr LensFreedom kFocalOnly{.focal = true, .aspect = false, .principal = false};
  constexpr double kEdgeSigmaPx = 0.2;
  return FitLens(views, padded, kFocalOnly, kEdgeSigmaPx);
}

LandingTally Score(const LandingFrameSet& set, const CameraIntrinsics& camera) {
  const LandingPatternDetector detector{CameraModel(camera), {}};
  return LandingTally(ScoreFrames(detector, set.frames.size(), kThreads, NoHint,
                                  [&](std::size_t i) { return set.frames[i]; }));
}

std::string FoundCells(const LandingTally& tally) {
  return fmt::format("{} of {} | {:.2f} | {:.2f}", tally.found, tally.frames,
                     Quantile(tally.center_errors_px, 0.5), Quantile(tally.center_errors_px, 0.95));
}

void ReportReal(const Options& options) {
  std::vector<LandingFrameSet> sets = ReadLandingReal(options.data_dir);
  std::erase_if(sets, [](const LandingFrameSet& set) {
    return set.camera.distortion_model == DistortionModel::kEquidistant;
  });
  if (sets.empty()) {
    fmt::print("there is no {}/landing_real\n", options.data_dir);
    return;
  }
  const LensCalibration lens = CalibrateLens(ImagesOf(sets), {});
  const CameraIntrinsics& camera = lens.intrinsics;
  fmt::print(
      "\n## Real sequences\n\nThe focal length of each with all else as it is of all.\n\n"
      "| sequence | views used | focal length, px | f = 370: found | centre error median, px | "
      "95 %, px | this lens: found | its centre error median, px | its 95 %, px "
      "|\n|---|---|---|---|---|---|---|---|---|\n");
  double squares = 0;
  int fitted = 0;
  for (const LandingFrameSet& set : sets) {
    std::vector<LensView> views;
    for (const LensView& view : lens.views) {
      if (view.name.starts_with(set.name + "/")) views.push_back(view);
    }
    const std::optional<LensFit> fit = FitFocal(views, camera);
    std::string focal = "none";
    if (fit) {
      focal = fmt::format("{:.1f} +- {:.1f}", fit->intrinsics.fx_px, fit->sigmas(kFocal));
      squares += std::pow(fit->intrinsics.fx_px - camera.fx_px, 2);
      ++fitted;
    }
    fmt::print("| {} | {} | {} | {} | {} |\n", set.name, views.size(), focal,
               FoundCells(Score(set, set.camera)), FoundCells(Score(set, camera)));
    std::fflush(stdout);
  }
  fmt::print(
      "\n| all sequences: views | focal length, px | from those of the sequences, RMS, px | "
      "principal point, px | distortion | residual, px | coverage "
      "|\n|---|---|---|---|---|---|---|\n"
      "| {} | {:.1f} +- {:.1f} | {:.1f} | ({:.1f}, {:.1f}) +- ({:.1f}, {:.1f}) | {} [{:.4f}] | "
      "{:.2f} | {} |\n",
      lens.views.size(), camera.fx_px, lens.fit.sigmas(kFocal),
      std::sqrt(squares / std::max(fitted, 1)), camera.cx_px, camera.cy_px,
      lens.fit.sigmas(kPrincipalX), lens.fit.sigmas(kPrincipalY),
      DistortionName(camera.distortion_model), fmt::join(camera.distortion, ", "),
      lens.fit.RootMeanSquare(), lens.coverage.InWords());
}

int Run(int argc, char** argv) {
  Options options;
  CLI::App app{"Lenses from views of the landing pattern"};
  app.add_option("--data", options.data_dir, "folder with landing_real");
  app.add_option("--views", options.views, "rendered views per lens")->check(CLI::PositiveNumber);
  app.add_option("--seeds", options.seeds, "sets of rendered views per lens; 0: none")
      ->check(CLI::NonNegativeNumber);
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  ReportRendered(options);
  ReportReal(options);
  return 0;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  return kestrel::ReportMain([&] { return kestrel::Run(argc, argv); });
}
