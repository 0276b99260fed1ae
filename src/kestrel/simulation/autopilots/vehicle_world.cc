// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/vehicle_world.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

constexpr double kWaiting = std::numeric_limits<double>::infinity();
// Duration of the track that is painted on the ground and kept free of things.
constexpr double kTrackDuration_s = 60;

// The vehicles of `sim:SCENARIO`.
std::vector<VehicleScenario> MakeSitlScenarios() {
  std::vector<VehicleScenario> scenarios = {
      {"standing", "a vehicle that stands at the origin", {"vehicle.path=standing"}},
      {"straight",
       "waits at the origin until the UAV has been 5 m high, then drives straight on at 2 m/s",
       {"vehicle.path=straight", "vehicle.speed_mps=2", "drive_altitude_m=5", "drive_delay_s=5"}},
      {"circle",
       "drives on a circle of 15 m around the origin at 2 m/s",
       {"vehicle.path=circle", "vehicle.speed_mps=2"}},
      {"follow",
       "a person to follow, who waits until the UAV has been 5 m high, then walks, stops and turns",
       {"thing.kind=person", "vehicle.path=stops", "vehicle.speed_mps=1.6", "drive_altitude_m=5",
        "drive_delay_s=15", "surroundings.landing_legs=false"}},
      {"hunt",
       "the contest's field: ten discs that stand and ten that move at up to 5 km/h",
       {"field.length_m=30", "field.width_m=20", "field.objects.red=4", "field.objects.green=3",
        "field.objects.blue=3", "field.objects.yellow=10", "field.objects.yellow_speed_mps=0.9",
        "field.objects.orange=0", "field.objects.orange_bars=0", "field.objects.distractors=5",
        "surroundings.landing_legs=false"}},
      {"indoor",
       "a pad on the floor of a hall under lamps: 12 m long and wide, 5 m high",
       {"vehicle.path=standing", "room.side_m=12", "room.ceiling_m=5", "ground.material=concrete",
        "ground.markings=0", "ground.curb=false", "ground.shadows=false", "light.direct=0.3",
        "light.sun_elevation_deg=80", "light.sky_radiance=0.3", "surroundings.vehicles=0",
        "surroundings.lookalikes=0", "surroundings.banners=0"}},
      {"figure8",
       "the contest: 15 km/h on a figure of eight through the origin",
       {"vehicle.path=figure8", "vehicle.speed_mps=4.2"}},
  };
  std::ranges::copy(HardVehicles(), std::back_inserter(scenarios));
  return scenarios;
}

const std::vector<VehicleScenario>& SitlScenarios() {
  static const std::vector<VehicleScenario> scenarios = MakeSitlScenarios();
  return scenarios;
}

const VehicleScenario& FindSitlScenario(const std::string& name) {
  std::vector<const char*> names;
  for (const VehicleScenario& scenario : SitlScenarios()) {
    if (name == scenario.name) return scenario;
    names.push_back(scenario.name);
  }
  throw InputError(
      fmt::format("there is no scenario 'sim:{}', expected {}", name, fmt::join(names, ", ")));
}

// The field is around the origin, where the pilot begins.
LandingScene MakeFieldScene(const VehicleWorldOptions& options, std::uint64_t seed,
                            ObjectField* field) {
  LandingScene scene;
  scene.world_from_pattern = [](double) { return RigidTransform(); };
  scene.target = [](double) { return Eigen::Vector3d(0, 0, 0); };
  scene.print = PrintOfTarget(options.target, scene.pattern);
  World& world = scene.world;
  world.channels = 3;
  Random ground_random = RandomOf(seed, LandingPart::kGround);
  world.ground = MakeGround(options.ground, {}, world.channels, &ground_random);
  Random light_random = RandomOf(seed, LandingPart::kLight);
  world.light = MakeLighting(options.light, &light_random);
  world.skyline = MakeSkyline(&light_random);
  Random field_random = RandomOf(seed, LandingPart::kSurroundings);
  field->Draw(options.field, &field_random, &world);
  return scene;
}

// A thing stands where the pad would be.
LandingScene MakeScene(const VehicleWorldOptions& options, std::uint64_t seed, ObjectField* field) {
  if (options.field.is_there()) return MakeFieldScene(options, seed, field);
  if (!options.thing.is_there()) {
    LandingScene landing = MakeLandingScene(options, kTrackDuration_s, /*channels=*/1, seed);
    if (options.room.is_there()) AddRoom(options.room, &landing.world);
    return landing;
  }
  LandingScene scene;
  Random random = RandomOf(seed, LandingPart::kVehicle);
  scene.world_from_pattern = VehicleMotion(options.vehicle, &random);
  scene.target = [thing = scene.world_from_pattern](double time_s) {
    return Eigen::Vector3d(thing(time_s).translation);
  };
  // The UAV is expected behind it.
  const Path eye = [thing = scene.world_from_pattern](double time_s) {
    return Eigen::Vector3d(thing(time_s) * Eigen::Vector3d(-12, 0, 8));
  };
  scene.world = MakeFollowScene(options.thing, {options.ground, options.light},
                                scene.world_from_pattern, eye, /*channels=*/3, seed)
                    .world;
  scene.print = PrintOfTarget(options.target, scene.pattern);
  return scene;
}

}  // namespace

// The board is at the height of the ground, because a simulated autopilot lands on nothing else.
// There are few things around, because every surface costs time in each frame; a coarser ground is
// drawn sooner.
VehicleWorldOptions::VehicleWorldOptions() {
  thing.kind = "none";
  board.carrier = "none";
  ground.map_px = 2048;
  surroundings.vehicles = 1;
  surroundings.lookalikes = 1;
  surroundings.banners = 1;
}

VehicleWorldOptions ReadVehicleWorld(const std::string& scenario,
                                     const std::vector<std::string>& settings,
                                     const TargetOptions& target) {
  VehicleWorldOptions options;
  options.target = target;
  for (const char* setting : FindSitlScenario(scenario).settings) SetOption(setting, &options);
  for (const std::string& setting : settings) SetOption(setting, &options);
  RequireValid(options);
  return options;
}

VehicleWorld::VehicleWorld(const VehicleWorldOptions& options, Time start, std::uint64_t seed)
    : options_(Checked(options)),
      start_(options.start_s > 0 ? Time(DurationFromSeconds(options.start_s)) : start),
      departure_s_(kWaiting),
      scene_(MakeScene(options, seed, &field_)) {
  const auto delayed = [this](const auto& motion) {
    return [this, motion](double time_s) { return motion(DrivenTime(time_s)); };
  };
  // The vehicle, or the thing and its look-alikes; whatever else has a body stands.
  for (Motion& body : scene_.world.bodies) body = delayed(body);
  scene_.world_from_pattern = delayed(scene_.world_from_pattern);
  scene_.target = delayed(scene_.target);
}

RigidTransform VehicleWorld::PatternAt(Time time) const {
  return scene_.world_from_pattern(SceneTime(time));
}

Eigen::Vector3d VehicleWorld::VelocityAt(Time time) const {
  return VelocityOf(scene_.world_from_pattern, SceneTime(time));
}

bool VehicleWorld::IsOnBoard(const Eigen::Vector3d& point_in_pattern) const {
  if (options_.thing.is_there() || options_.field.is_there()) return false;
  const double half = 0.5 * scene_.print.board_size_m + options_.board.border_m;
  return ReachOnBoard(scene_.print, point_in_pattern.head<2>()) <= half;
}

void VehicleWorld::ObserveUav(Time time, const Eigen::Vector3d& position_in_world) {
  if (position_in_world.z() < options_.drive_altitude_m) return;
  double waiting = kWaiting;
  departure_s_.compare_exchange_strong(waiting, SceneTime(time) + options_.drive_delay_s);
}

void VehicleWorld::ListenToPoses(const void* owner, PoseListener listener) {
  const std::lock_guard lock(listener_mutex_);
  listeners_[owner] = std::move(listener);
}

void VehicleWorld::ReportPose(const PoseSample& pose, const PlatformAttitude& platform) {
  ObserveUav(pose.time, pose.world_from_body.translation);
  const std::lock_guard lock(listener_mutex_);
  for (const auto& [owner, listener] : listeners_) {
    if (listener) listener(pose, platform);
  }
}

// Returns how long it would have driven at full speed to be where it is.
double VehicleWorld::DrivenTime(double scene_time_s) const {
  if (options_.drive_altitude_m <= 0) return scene_time_s;
  const double driving_s = scene_time_s - departure_s_;
  if (!(driving_s > 0)) return 0;
  const double start_s = options_.vehicle.speed_mps / options_.drive_acceleration;
  if (driving_s < start_s) return driving_s * driving_s / (2 * start_s);
  return driving_s - 0.5 * start_s;
}

}  // namespace kestrel
