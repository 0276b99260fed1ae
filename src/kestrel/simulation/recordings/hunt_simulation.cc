// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/hunt_simulation.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <Eigen/Geometry>

#include "kestrel/core/base/hash.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/recordings/hunt_truth.h"
#include "kestrel/simulation/recordings/truth_text.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/scene/solids.h"
#include "kestrel/simulation/vehicle/flight_time.h"
#include "kestrel/simulation/vehicle/multicopter_motion.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Each part of the scene has its own random numbers: options of one part do not change another.
enum class HuntPart { kObjects = 200, kFlight, kGround, kLight, kSurroundings };
Random RandomOf(std::uint64_t seed, HuntPart part) {
  return Random(Hash(seed, static_cast<std::uint64_t>(part)));
}

// Back and forth along x, one lane further in y at every turn; smooth.
Path SweepPath(const HuntFlightOptions& options, Random* random) {
  // Larger values make the lanes straighter and the turns sharper; below 1.
  constexpr double kStraightness = 0.95;
  const double whole = std::asin(kStraightness);
  const double rate = 2 * options.speed_mps * whole / (options.length_m * kStraightness);
  const double half_length = 0.5 * options.length_m;
  const double start_y = -0.5 * options.width_m + (0.5 + options.first_lane) * options.lane_m;
  const auto wave = Wander(0.15, 7, random);
  return [=, lane = options.lane_m, altitude = options.altitude_m](double time_s) {
    const double phase = rate * time_s - 0.4 * kPi;
    const double x = half_length * std::asin(kStraightness * std::sin(phase)) / whole;
    // The integral of (1 - cos(2 phase))^2: constant along the lanes, changing in the turns.
    const double turns =
        (1.5 * phase - std::sin(2 * phase) + 0.125 * std::sin(4 * phase)) / (1.5 * kPi);
    return Vector3d(x, start_y + lane * (turns + 0.4), altitude + wave(time_s));
  };
}

// Descends from a place a few metres beside the object and high above it to one low above it.
Path DescentPath(const HuntFlightOptions& options, const Path& object, double duration_s,
                 Random* random) {
  const double side = random->Uniform(0, 2 * kPi);
  const Vector2d beside = 0.45 * options.altitude_m * Vector2d(std::cos(side), std::sin(side));
  const double ratio = options.end_altitude_m / options.altitude_m;
  const auto sway_x = Wander(0.08, 4, random);
  const auto sway_y = Wander(0.08, 4, random);
  return [=, altitude_m = options.altitude_m](double time_s) {
    const double part = std::clamp(time_s / duration_s, -0.1, 1.1);
    const double altitude = altitude_m * std::pow(ratio, part);
    const double left = 0.5 + 0.5 * std::cos(kPi * std::clamp(part, 0.0, 1.0));
    const Vector3d offset(left * beside.x() + sway_x(time_s), left * beside.y() + sway_y(time_s),
                          altitude);
    return Vector3d(object(time_s) + offset);
  };
}

struct HuntScene {
  World world;
  std::vector<HuntObject> objects;
  Motion world_from_uav;
};

Motion UavMotion(const HuntFlightOptions& options, const std::vector<HuntObject>& objects,
                 double duration_s, Random* random) {
  const Path path = options.path == "sweep"
                        ? SweepPath(options, random)
                        : DescentPath(options, objects.front().center, duration_s, random);
  const double heading = options.path == "sweep" ? 0 : random->Uniform(0, 2 * kPi);
  const auto turning = Wander(0.06, 6, random);
  const auto yaw = [=](double time_s) { return heading + turning(time_s); };
  return MulticopterMotion(path, yaw, options.attitude_noise_deg, random);
}

void AddSurroundings(const HuntSimulationOptions& options, Random* random, World* world) {
  const Vector2d half(0.5 * options.flight.length_m, 0.5 * options.flight.width_m);
  for (int i = 0; i < options.banners; ++i) {
    // Along the edges of the area.
    const double along = random->Uniform(-1, 1);
    const bool at_end = random->Chance(0.4);
    const double side = random->Chance(0.5) ? 1.05 : -1.05;
    const Vector2d place = at_end ? Vector2d(side * half.x(), along * half.y())
                                  : Vector2d(along * half.x(), side * half.y());
    const Color color = random->Chance(0.4) ? Gray(0.75) : Color(0.4, 0.12, 0.04);
    AddBanner(place, at_end ? kPi / 2 : 0, random->Uniform(3, 7), random->Uniform(0.8, 1.4), color,
              random, world);
  }
  for (int i = 0; i < options.vehicles; ++i) {
    const int body = static_cast<int>(world->bodies.size());
    const Vector2d place(random->Uniform(-half.x(), half.x()), 0.9 * half.y());
    world->bodies.push_back(Standing(place, random->Uniform(0, 2 * kPi)));
    AddCar(body, {0.05, 0.05, 0.4}, random, world);
  }
}

HuntScene MakeHuntScene(const HuntSimulationOptions& options, std::uint64_t seed) {
  HuntScene scene;
  World& world = scene.world;
  world.channels = 3;
  const std::uint64_t field_seed = options.field_seed > 0 ? options.field_seed : seed;
  Random objects_random = RandomOf(field_seed, HuntPart::kObjects);
  const Vector2d half_area(0.46 * options.flight.length_m, 0.46 * options.flight.width_m);
  scene.objects = AddHuntObjects(options.objects, half_area, &objects_random, &world);
  Random flight_random = RandomOf(seed, HuntPart::kFlight);
  scene.world_from_uav =
      UavMotion(options.flight, scene.objects, options.recording.duration_s(), &flight_random);
  Random ground_random = RandomOf(field_seed, HuntPart::kGround);
  world.ground = MakeGround(options.ground, {}, world.channels, &ground_random);
  Random light_random = RandomOf(field_seed, HuntPart::kLight);
  world.light = MakeLighting(options.light, &light_random);
  world.skyline = MakeSkyline(&light_random);
  Random surroundings_random = RandomOf(field_seed, HuntPart::kSurroundings);
  AddSurroundings(options, &surroundings_random, &world);
  if (options.uav_shadow) {
    world.bodies.push_back(scene.world_from_uav);
    AddUavShadow(static_cast<int>(world.bodies.size()) - 1, 0.8, &world);
  }
  return scene;
}

}  // namespace

std::vector<std::string> HuntSimulationOptions::Validate() const {
  std::vector<std::string> violations;
  const int count = objects.red + objects.green + objects.blue + objects.yellow + objects.orange +
                    objects.orange_bars;
  if (flight.path == "descend" && count == 0) {
    violations.emplace_back("flight.path is descend, expected at least one object");
  }
  RequireFixedLens(recording.zoom, &violations);
  return violations;
}

GroundOptions HuntSimulationOptions::Arena() {
  GroundOptions options;
  options.markings = 8;
  options.map_size_m = 44;
  return options;
}

FlightRecordingOptions HuntSimulationOptions::ConsumerCamera() {
  FlightRecordingOptions options;
  options.frames = 420;
  options.rate_hz = 10;
  options.navigation.vibration_deg = 0.12;
  options.lens = {.half_angle_deg = 60, .vignette = 0.5};
  options.shutter = {.exposure_s = 0.003, .readout_s = 0.025, .rays_per_pixel = 6};
  options.sensor.gain_variation = 0.05;
  options.sensor.gamma = 0.5;
  options.sensor.blur_sigma_px = 0.7;
  options.sensor.sharpening = 0.6;
  options.sensor.jpeg_quality = 93;
  return options;
}

CameraCalibration HuntCalibration() {
  Eigen::Matrix3d axes;
  axes.col(0) = -Vector3d::UnitY();
  axes.col(1) = -Vector3d::UnitX();
  axes.col(2) = -Vector3d::UnitZ();
  CameraCalibration calibration;
  calibration.intrinsics = {.width_px = 1280,
                            .height_px = 720,
                            .fx_px = 800,
                            .fy_px = 800,
                            .cx_px = 640.5,
                            .cy_px = 361,
                            .distortion_model = DistortionModel::kRadialTangential,
                            .distortion = {-0.3, 0.1, 0.0005, -0.0003}};
  calibration.body_from_camera = RigidTransform{Eigen::Quaterniond(axes), {0.08, 0, -0.08}};
  return calibration;
}

RecordingPlan PlanHunt(const HuntSimulationOptions& options, const CameraCalibration& camera,
                       std::uint64_t seed) {
  RequireValid(options);
  HuntScene scene = MakeHuntScene(options, seed);
  const Motion world_from_uav = scene.world_from_uav;
  const Path below = [world_from_uav](double time_s) {
    const Vector3d place = world_from_uav(time_s).translation;
    return Vector3d(place.x(), place.y(), 0);
  };
  const auto flight = std::make_shared<SimulatedFlight>(
      options.recording, camera, Drawing(), std::move(scene.world), world_from_uav, below, seed);
  RecordingPlan plan;
  for (const double time_s : flight->times_s()) plan.times.push_back(TimeOfFlight(time_s));
  plan.render = [flight](std::size_t i) { return flight->Image(i); };
  plan.scene = flight->SceneText("hunt") + "options:\n" + Indented(PrintOptions(options));
  plan.files = flight->Files();
  plan.files.push_back({"objects0/objects.csv", ObjectsText(scene.objects)});
  plan.files.push_back({"objects0/data.csv", ObjectRowsText(scene.objects, *flight)});
  if (options.objects.shape == "cuboid") {
    plan.files.push_back({"objects0/digits.csv", DigitsText(scene.objects)});
  }
  return plan;
}

}  // namespace kestrel
