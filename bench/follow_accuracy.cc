// SPDX-License-Identifier: BSD-3-Clause
// Pads that are followed down to 0.35 m under the shadow of the UAV, with one or two corners out of
// the image, through the pipeline of a flight: what is found by altitude, how far off it is, and
// how much of it is false. Usage:
// follow_accuracy [--target KIND] [--board FILE] [--descents N] [--seed N]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "for_each_index.h"
#include "kestrel/core/base/hash.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/labelled_images/shadow_casters.h"
#include "kestrel/simulation/rendering/flight_camera.h"
#include "kestrel/simulation/scene/landing_scene.h"
#include "kestrel/simulation/scene/paint.h"
#include "kestrel/simulation/scene/solids.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"
#include "pad_settings.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr std::array<double, 6> kBinEdges{0.35, 0.5, 0.7, 1, 1.4, 2};  // altitude, m
constexpr double kPadSize_m = 1;
constexpr double kFrameRate_hz = 10;
constexpr double kDuration_s = 3;
// A pose farther off is false.
constexpr double kFalse_m = 0.04;
constexpr double kFalseTurn = Radians(5);

struct Sighting {
  double altitude_m = 0;
  bool found = false;
  bool is_false = false;
  double error_m = 0;
};

// --- The scene ---

// Returns the share of the sunlight that the parts of a UAV block, over a square of 'size_m'.
std::shared_ptr<const Texture> OpacityOf(std::vector<Shadow> parts, double size_m) {
  constexpr int kSize_px = 1024;
  std::sort(parts.begin(), parts.end(),
            [](const Shadow& a, const Shadow& b) { return a.transmission > b.transmission; });
  SquarePaint opacity(kSize_px, size_m, Gray(0));
  for (const Shadow& part : parts) opacity.Draw(part.shape, Gray(1 - part.transmission));
  return opacity.ToTexture(1);
}

void AddShadowOf(const ShadowCaster& uav, const Motion& world_from_uav, Random* random,
                 World* world) {
  constexpr double kHalf_m = 2;
  const SunLight sun{.center = {0, 0}, .height_m = 1, .ambient = 0};
  world->bodies.push_back(world_from_uav);
  Surface& shadow = AddPlate(static_cast<int>(world->bodies.size()) - 1, {0, 0, 0.05}, kHalf_m,
                             kHalf_m, 0, nullptr, world);
  shadow.mask = OpacityOf(uav.cast(sun, random), 2 * kHalf_m);
  shadow.visible = false;
}

LandingScene MakeScene(const TargetOptions& target, Random* random) {
  LandingSceneOptions options;
  options.target = target;
  options.vehicle.path = "standing";
  options.vehicle.shake_deg = 0;
  options.board.carrier = "none";
  options.surroundings.vehicles = 0;
  options.surroundings.lookalikes = 0;
  options.surroundings.banners = 0;
  options.ground.markings = 0;
  options.ground.curb = false;
  options.ground.shadows = false;
  options.ground.map_size_m = 16;
  options.ground.map_px = 1024;
  options.light.direct = random->Uniform(0.5, 0.9);
  return MakeLandingScene(options, kDuration_s, 1, random->Bits());
}

// --- The flight ---

// A descent at a constant rate, to a place beside the pad's middle, with some tilt.
Motion DrawDescent(const RigidTransform& world_from_pad, Random* random) {
  constexpr double kTilt = Radians(2.5);
  const double heading = random->Uniform(0, 2 * kPi);
  const double way = random->Uniform(0, 2 * kPi);
  const double aside = random->Uniform(0, 0.35);
  const auto roll = Wander(kTilt, 1.5, random);
  const auto pitch = Wander(kTilt, 1.5, random);
  const auto sway = Wander(0.03, 2, random);
  return [=](double time_s) {
    const double share = std::clamp(time_s / kDuration_s, 0.0, 1.0);
    const double altitude = kBinEdges.back() + share * (kBinEdges.front() - kBinEdges.back());
    const Eigen::Vector3d place((aside + sway(time_s)) * std::cos(way),
                                (aside + sway(time_s)) * std::sin(way), altitude);
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(pitch(time_s), Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(roll(time_s), Eigen::Vector3d::UnitX()));
    return RigidTransform{turned, world_from_pad.translation + place};
  };
}

// Looks down; the top of its image is forward.
CameraCalibration LookingDown() {
  Eigen::Matrix3d axes;
  axes << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  CameraCalibration calibration;
  calibration.intrinsics = PaperCamera();
  calibration.body_from_camera = RigidTransform{Eigen::Quaterniond(axes), Eigen::Vector3d::Zero()};
  return calibration;
}

int CornersOutOfView(const Lens& lens, const RigidTransform& camera_from_pad) {
  constexpr double kHalf = 0.5 * kPadSize_m;
  int out = 0;
  for (const double x : {-kHalf, kHalf}) {
    for (const double y : {-kHalf, kHalf}) {
      out += !lens.Sees(camera_from_pad * Eigen::Vector3d(x, y, 0));
    }
  }
  return out;
}

double TimeOf(int frame) { return frame / kFrameRate_hz; }
constexpr int kFrames = static_cast<int>(kDuration_s * kFrameRate_hz);

// Returns whether one or two corners are out of view in most frames below 1 m, and never more.
bool LosesCorners(const Lens& lens, const Motion& world_from_camera,
                  const RigidTransform& world_from_pad) {
  int frames = 0, cut = 0;
  for (int i = 0; i < kFrames; ++i) {
    const RigidTransform camera_from_pad = world_from_camera(TimeOf(i)).Inverse() * world_from_pad;
    if (camera_from_pad.translation.norm() > 1) continue;
    const int out = CornersOutOfView(lens, camera_from_pad);
    if (out > 2) return false;
    ++frames;
    cut += out > 0;
  }
  return 2 * cut > frames;
}

Motion DescentThatLosesCorners(const Lens& lens, const CameraCalibration& calibration,
                               const RigidTransform& world_from_pad, Random* random) {
  while (true) {
    const Motion world_from_uav = DrawDescent(world_from_pad, random);
    const Motion world_from_camera = [&](double time_s) {
      return world_from_uav(time_s) * *calibration.body_from_camera;
    };
    if (LosesCorners(lens, world_from_camera, world_from_pad)) return world_from_uav;
  }
}

// Adds errors of the navigation to a pose.
RigidTransform Navigated(const RigidTransform& pose, Random* random) {
  constexpr double kPlace_m = 0.01, kTurn = Radians(0.3);
  const auto draw = [&](double sigma) {
    const double x = random->Normal();
    const double y = random->Normal();
    const double z = random->Normal();
    return Eigen::Vector3d(sigma * Eigen::Vector3d(x, y, z));
  };
  const Eigen::Vector3d place = pose.translation + draw(kPlace_m);
  return {RotationBy(draw(kTurn)) * pose.rotation, place};
}

SensorOptions DrawSensor(Random* random) {
  SensorOptions sensor;
  sensor.white_level = random->Uniform(150, 330);
  sensor.read_noise = random->Uniform(1, 4);
  sensor.blur_sigma_px = random->Uniform(0.4, 0.9);
  return sensor;
}

// Puts the sun where the UAV's shadow falls on the pad, near its middle, from low above it.
void PutSunBehind(const Motion& world_from_uav, const RigidTransform& world_from_pad,
                  Random* random, World* world) {
  constexpr double kAltitude_m = 0.6, kReach_m = 0.35;
  const double share = (kBinEdges.back() - kAltitude_m) / (kBinEdges.back() - kBinEdges.front());
  const double x = random->Uniform(-kReach_m, kReach_m);
  const double y = random->Uniform(-kReach_m, kReach_m);
  const Eigen::Vector3d shaded = world_from_pad * Eigen::Vector3d(x, y, 0);
  world->light.to_sun = (world_from_uav(share * kDuration_s).translation - shaded).normalized();
}

// --- What is seen ---

double TurnBetween(const TargetDetection& detection, const RigidTransform& truth) {
  double least = kPi;
  for (int i = 0; i < detection.heading_symmetry; ++i) {
    const Eigen::Quaterniond turn = RotationBy({0, 0, i * 2 * kPi / detection.heading_symmetry});
    least = std::min(least,
                     detection.camera_from_target.rotation.angularDistance(truth.rotation * turn));
  }
  return least;
}

Sighting Measure(double altitude_m, const std::optional<TargetDetection>& detection,
                 const RigidTransform& truth) {
  Sighting sighting{.altitude_m = altitude_m, .found = detection.has_value()};
  if (!detection) return sighting;
  sighting.error_m = (detection->camera_from_target.translation - truth.translation).norm();
  sighting.is_false = sighting.error_m > kFalse_m || TurnBetween(*detection, truth) > kFalseTurn;
  return sighting;
}

std::vector<Sighting> FlyDown(const TargetOptions& target, const ShadowCaster& uav,
                              std::uint64_t seed) {
  Random random(seed);
  const CameraCalibration calibration = LookingDown();
  const CameraModel model(calibration.intrinsics);
  LandingScene scene = MakeScene(target, &random);
  const RigidTransform world_from_pad = scene.world_from_pattern(0);
  const Motion world_from_uav =
      DescentThatLosesCorners(Lens(model), calibration, world_from_pad, &random);
  PutSunBehind(world_from_uav, world_from_pad, &random, &scene.world);
  AddShadowOf(uav, world_from_uav, &random, &scene.world);
  const FlightCamera camera(
      model, {}, {.rays_per_pixel = 4}, DrawSensor(&random), scene.world,
      [&](double time_s) { return world_from_uav(time_s) * *calibration.body_from_camera; });
  LandingPipelineOptions options;
  options.target = target;
  LandingPipeline pipeline(calibration, options);
  std::vector<Sighting> sightings;
  for (int i = 0; i < kFrames; ++i) {
    const double time_s = TimeOf(i);
    const Time time = TimeFromNanoseconds(1'000'000'000 + std::llround(1e9 * time_s));
    pipeline.AddPose({time, Navigated(world_from_uav(time_s), &random)});
    const cv::Mat image = camera.Capture(time_s, 1, random.Bits());
    const RigidTransform pad_from_uav = world_from_pad.Inverse() * world_from_uav(time_s);
    sightings.push_back(Measure(pad_from_uav.translation.z(),
                                pipeline.Process(image, time).report.detection,
                                camera.WorldFromCamera(time_s).Inverse() * world_from_pad));
  }
  return sightings;
}

// --- The table ---

void PrintBin(double from_m, double to_m, const std::vector<std::vector<Sighting>>& descents) {
  int frames = 0, found = 0, wrong = 0;
  std::vector<double> errors_m;
  for (const std::vector<Sighting>& sightings : descents) {
    for (const Sighting& sighting : sightings) {
      if (sighting.altitude_m < from_m || sighting.altitude_m >= to_m) continue;
      ++frames;
      if (!sighting.found) continue;
      wrong += sighting.is_false;
      found += !sighting.is_false;
      errors_m.push_back(sighting.error_m);
    }
  }
  fmt::print("| {} to {} m | {} | {:.1f} % | {} | {:.1f} mm |\n", from_m, to_m, frames,
             100.0 * found / frames, wrong,
             errors_m.empty() ? NAN : 1000 * MedianInPlace(errors_m));
}

void PrintHead(const std::string& kind, std::string_view shadow) {
  fmt::print("\n{}, {}\n\n", kind, shadow);
  fmt::print("| altitude | frames | found | false | error median |\n|---|---|---|---|---|\n");
}

void Run(const PadSettings& settings) {
  cv::setNumThreads(1);
  TargetOptions target = settings.target;
  target.size_m = kPadSize_m;
  std::vector<std::vector<Sighting>> all;
  std::uint64_t kind = 0;
  for (const ShadowCaster& uav : UavShadowCasters()) {
    std::vector<std::vector<Sighting>> descents(settings.count);
    ForEachIndex(descents.size(), [&](std::size_t i) {
      descents[i] = FlyDown(target, uav, Hash(settings.seed + i, kind));
    });
    ++kind;
    PrintHead(target.kind, uav.name);
    PrintBin(kBinEdges.front(), 1, descents);
    all.insert(all.end(), descents.begin(), descents.end());
  }
  PrintHead(target.kind, "all");
  for (std::size_t bin = 0; bin + 1 < kBinEdges.size(); ++bin) {
    PrintBin(kBinEdges[bin], kBinEdges[bin + 1], all);
  }
  PrintBin(kBinEdges.front(), 1, all);
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("Pads that are followed to the ground under the shadow of the UAV");
  kestrel::PadSettings settings{.target = {}, .count = 20};
  kestrel::AddOptions(&app, "descents", "Number of descents under each shadow", &settings);
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] {
    kestrel::Run(settings);
    return 0;
  });
}
