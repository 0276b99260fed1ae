// SPDX-License-Identifier: BSD-3-Clause
// Prints, by tilt and height, what an oblique camera finds on flights towards a pad on a standing
// vehicle, in the whole image and in the part that shows the ground. Each image is searched by
// itself. Usage: oblique_accuracy [--target KIND] [--flights N] [--seed N]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "kestrel/core/base/hash.h"
#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/simulation/recordings/second_camera.h"
#include "kestrel/simulation/rendering/flight_camera.h"
#include "kestrel/simulation/scene/landing_scene.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"
#include "kestrel/vision/targets/make_target_detector.h"
#include "pad_settings.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr double kView_deg = 90;
constexpr double kFarthest_m = 40, kStep_m = 1.5;  // horizontal distance from the pad
constexpr std::array kTilts_deg = {45.0, 70.0, 80.0};
constexpr std::array kHeights_m = {5.0, 10.0, 15.0};

// Results of one way of searching.
struct Search {
  int found = 0, wrong = 0;
  double farthest_m = 0;  // of the pads that are found
  std::vector<double> times_ms;
};

// The images of a tilt and a height.
struct Views {
  int images = 0, with_pad = 0;
  double farthest_m = 0;
  Search whole, part;
};

class ObliqueFlight {
 public:
  ObliqueFlight(double tilt_deg, const TargetOptions& target, std::uint64_t seed)
      : scene_(MakeLandingScene(SceneOf(target), 1, 1, seed)),
        calibration_(SecondCalibration(kView_deg, tilt_deg)),
        lens_(calibration_.intrinsics),
        detector_(MakeTargetDetector(lens_, target, {})),
        workspace_(detector_->MakeWorkspace()),
        camera_(lens_, {}, Shutter(), {}, scene_.world,
                [this](double) { return world_from_camera_; }),
        heading_(Random(seed).Uniform(-std::numbers::pi, std::numbers::pi)),
        seed_(seed) {}

  void Fly(double height_m, Views* views) {
    const Eigen::Vector3d pad = scene_.world_from_pattern(0).translation;
    const Eigen::AngleAxisd yaw(heading_, Eigen::Vector3d::UnitZ());
    for (double away_m = kFarthest_m; away_m >= 0; away_m -= kStep_m) {
      const RigidTransform world_from_body{Eigen::Quaterniond(yaw),
                                           pad + yaw * Eigen::Vector3d(-away_m, 0, height_m)};
      world_from_camera_ = world_from_body * *calibration_.body_from_camera;
      Look(height_m, views);
    }
  }

 private:
  static LandingSceneOptions SceneOf(const TargetOptions& target) {
    LandingSceneOptions options;
    options.vehicle.path = "standing";
    options.target = target;
    return options;
  }
  static ShutterOptions Shutter() {
    ShutterOptions shutter;
    shutter.rays_per_pixel = 3;
    return shutter;
  }

  void Look(double height_m, Views* views) {
    const cv::Mat image = camera_.Capture(0, 1, Hash(seed_, static_cast<std::uint64_t>(++taken_)));
    const Eigen::Vector3d pad =
        world_from_camera_.Inverse() * scene_.world_from_pattern(0).translation;
    ++views->images;
    if (IsInView(pad)) {
      ++views->with_pad;
      views->farthest_m = std::max(views->farthest_m, pad.norm());
    }
    TargetHint hint;
    hint.altitude_m = height_m;
    hint.up_in_camera = world_from_camera_.rotation.conjugate() * Eigen::Vector3d::UnitZ();
    Find(image, hint, pad, &views->whole);
    hint.sky_above_rad = LandingPipeline::kSkyMargin_rad;
    Find(image, hint, pad, &views->part);
  }
  // True if all of the pad is in view.
  bool IsInView(const Eigen::Vector3d& pad_in_camera) const {
    constexpr double kRadius_m = 0.5;
    Eigen::Vector2d pixel;
    if (lens_.Project(pad_in_camera, &pixel) != ProjectionStatus::kOk) return false;
    const double margin_px = lens_.intrinsics().fx_px * kRadius_m / pad_in_camera.norm();
    return pixel.x() > margin_px && pixel.y() > margin_px &&
           pixel.x() < lens_.width_px() - margin_px && pixel.y() < lens_.height_px() - margin_px;
  }
  void Find(const cv::Mat& image, const TargetHint& hint, const Eigen::Vector3d& pad,
            Search* search) {
    constexpr double kTolerated = 0.1;        // share of the distance
    const std::clock_t start = std::clock();  // time of the processor, which others may load
    const TargetReport report = detector_->Detect(image, hint, *workspace_);
    search->times_ms.push_back(1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    if (!report.detection) return;
    const Eigen::Vector3d& found = report.detection->camera_from_target.translation;
    if ((found - pad).norm() > kTolerated * pad.norm()) {
      ++search->wrong;
      return;
    }
    ++search->found;
    search->farthest_m = std::max(search->farthest_m, pad.norm());
  }

  LandingScene scene_;
  CameraCalibration calibration_;
  CameraModel lens_;
  std::unique_ptr<const TargetDetector> detector_;
  std::unique_ptr<TargetWorkspace> workspace_;
  RigidTransform world_from_camera_;
  FlightCamera camera_;
  double heading_;
  std::uint64_t seed_;
  int taken_ = 0;
};

void Run(const PadSettings& settings) {
  fmt::print(
      "| tilt, height | images, with the pad, farthest | whole image: found, wrong, farthest, "
      "median | below the horizon |\n|---|---|---|---|\n");
  const auto text = [](Search search) {
    return fmt::format("{}, {}, {:.1f} m, {:.1f} ms", search.found, search.wrong, search.farthest_m,
                       MedianInPlace(search.times_ms));
  };
  for (const double tilt_deg : kTilts_deg) {
    std::array<Views, kHeights_m.size()> views;
    for (int i = 0; i < settings.count; ++i) {
      ObliqueFlight flight(tilt_deg, settings.target,
                           settings.seed + static_cast<std::uint64_t>(i));
      for (std::size_t h = 0; h < kHeights_m.size(); ++h) flight.Fly(kHeights_m[h], &views[h]);
    }
    for (std::size_t h = 0; h < kHeights_m.size(); ++h) {
      const Views& all = views[h];
      fmt::print("| {:.0f} degrees, {:.0f} m | {}, {}, {:.1f} m | {} | {} |\n", tilt_deg,
                 kHeights_m[h], all.images, all.with_pad, all.farthest_m, text(all.whole),
                 text(all.part));
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("What an oblique camera finds");
  kestrel::PadSettings settings{{}, 4};
  kestrel::AddOptions(&app, "flights", "Flights of each tilt and height", &settings);
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] {
    kestrel::Run(settings);
    return 0;
  });
}
