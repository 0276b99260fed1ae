// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/landing_scene.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "kestrel/core/base/hash.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/scene/board_paint.h"
#include "kestrel/simulation/scene/direction.h"
#include "kestrel/simulation/scene/landing_drawings.h"
#include "kestrel/simulation/scene/solids.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kLookalikePaint_px = 512;

Color CarColor(Random* random) {
  static const std::vector<Color> kColors = {Gray(0.7),  Gray(0.5),          Gray(0.12),
                                             Gray(0.03), {0.05, 0.05, 0.45}, {0.35, 0.12, 0.04}};
  return kColors[random->Integer(0, static_cast<int>(kColors.size()) - 1)];
}

LandingPattern DrawnPattern(const LandingSceneOptions& options, Random* random) {
  LandingPattern pattern = options.pattern;
  pattern.arm_half_length_m +=
      random->Uniform(-options.board.arm_variation_m, options.board.arm_variation_m);
  pattern.arm_half_length_m = std::min(pattern.arm_half_length_m, pattern.outer_radius_m());
  return pattern;
}

// Puts the board on its carrier. Returns the pad's pose on the vehicle.
RigidTransform AddBoard(int vehicle, const TargetPrint& print, const BoardOptions& options,
                        Random* random, World* world) {
  const Color color = CarColor(random);
  double height = options.carrier == "box" ? 0.25 : 0;
  if (options.carrier == "pickup") height = AddPickup(vehicle, color, random, world);
  if (options.carrier == "car") height = AddCar(vehicle, color, random, world);
  constexpr double kThickness_m = 0.04;
  // Distance from the roof to the board on its rack.
  const double gap = options.carrier == "none" ? 0 : 0.1;
  const double half = 0.5 * print.board_size_m + options.border_m;
  const double top = height + gap + kThickness_m;
  const auto dark = PlainPaint(Gray(0.04), world->channels);
  const std::size_t plate = world->surfaces.size();
  AddBox(vehicle, {{0, 0, top - 0.5 * kThickness_m}, {half, half, 0.5 * kThickness_m}},
         BoardPaint(print, {options.border_m, options.dirt, options.scratches}, world->channels,
                    random),
         dark, world);
  world->surfaces[plate].gloss = static_cast<float>(options.gloss);
  world->surfaces[plate].gloss_width = static_cast<float>(options.gloss_width_deg * kPi / 180);
  if (options.carrier == "box") {
    AddBox(vehicle, {{0, 0, 0.5 * height}, {0.6, 0.6, 0.5 * height}}, dark, dark, world);
  }
  return {Eigen::Quaterniond(Eigen::AngleAxisd(print.board_heading, Vector3d::UnitZ())),
          {0, 0, top}};
}

// Returns the vehicle's path during the flight and for some time before and after.
std::vector<Vector2d> Track(const Motion& vehicle, double duration_s) {
  constexpr double kMore_s = 8;
  constexpr double kStep_s = 0.1;
  std::vector<Vector2d> track;
  for (double time_s = -kMore_s; time_s < duration_s + kMore_s; time_s += kStep_s) {
    track.emplace_back(vehicle(time_s).translation.head<2>());
  }
  return track;
}

// Returns a place 'reach_m' around a point of the track, but not on the track.
Vector2d BesideTrack(const std::vector<Vector2d>& track, double clearance_m, double reach_m,
                     Random* random) {
  Vector2d place(0, 0);
  constexpr int kTries = 50;
  for (int i = 0; i < kTries; ++i) {
    const int near = random->Integer(0, static_cast<int>(track.size()) - 1);
    place = track[near] + random->Uniform(clearance_m, reach_m) * RandomDirection(random);
    const bool is_free = std::ranges::all_of(
        track, [&](const Vector2d& point) { return (point - place).norm() > clearance_m; });
    if (is_free) break;
  }
  return place;
}

void AddLookalike(const Vector2d& place, Random* random, World* world) {
  const auto kinds = Lookalikes();
  const Lookalike& kind = kinds[random->Integer(0, static_cast<int>(kinds.size()) - 1)];
  const double radius = random->Uniform(0.25, 0.6);
  const double half = 1.2 * radius;
  SquarePaint paint(kLookalikePaint_px, 2 * half, Gray(random->Uniform(0.6, 0.85)));
  paint.Draw(kind.draw({0, 0}, radius, random->Uniform(0, 2 * kPi), random), Gray(0.04));
  constexpr double kHeight_m = 0.004;
  AddPlate(0, {place.x(), place.y(), kHeight_m}, half, half, random->Uniform(0, 2 * kPi),
           paint.ToTexture(world->channels), world)
      .casts_shadow = false;
}

void AddSurroundings(const SurroundingsOptions& options, const std::vector<Vector2d>& track,
                     Random* random, World* world) {
  for (int i = 0; i < options.vehicles; ++i) {
    const Vector2d place = BesideTrack(track, 4, 12, random);
    const int body = static_cast<int>(world->bodies.size());
    world->bodies.push_back(Standing(place, random->Uniform(0, 2 * kPi)));
    const Color color = CarColor(random);
    if (random->Chance(0.5)) {
      AddCar(body, color, random, world);
    } else {
      AddPickup(body, color, random, world);
    }
  }
  for (int i = 0; i < options.lookalikes; ++i) {
    AddLookalike(BesideTrack(track, 2, 8, random), random, world);
  }
  for (int i = 0; i < options.banners; ++i) {
    const Color color = random->Chance(0.5) ? Gray(0.75) : Color(0.4, 0.15, 0.05);
    AddBanner(BesideTrack(track, 5, 18, random), random->Uniform(0, kPi), random->Uniform(3, 8),
              random->Uniform(0.8, 1.5), color, random, world);
  }
}

}  // namespace

Random RandomOf(std::uint64_t seed, LandingPart part) {
  return Random(Hash(seed, static_cast<std::uint64_t>(part)));
}

LandingScene MakeLandingScene(const LandingSceneOptions& options, double duration_s, int channels,
                              std::uint64_t seed) {
  LandingScene scene;
  World& world = scene.world;
  world.channels = channels;

  Random vehicle_random = RandomOf(seed, LandingPart::kVehicle);
  const Motion vehicle = VehicleMotion(options.vehicle, &vehicle_random);
  world.bodies.push_back(vehicle);
  Random board_random = RandomOf(seed, LandingPart::kBoard);
  scene.pattern = DrawnPattern(options, &board_random);
  scene.print = PrintOfTarget(options.target, scene.pattern);
  const RigidTransform vehicle_from_pattern =
      AddBoard(1, scene.print, options.board, &board_random, &world);
  scene.world_from_pattern = [=](double time_s) { return vehicle(time_s) * vehicle_from_pattern; };

  const Vector3d above(0, 0, vehicle_from_pattern.translation.z());
  scene.target = [=](double time_s) { return Vector3d(vehicle(time_s).translation + above); };

  const std::vector<Vector2d> track = Track(vehicle, duration_s);
  Random ground_random = RandomOf(seed, LandingPart::kGround);
  world.ground = MakeGround(options.ground, track, channels, &ground_random);
  Random light_random = RandomOf(seed, LandingPart::kLight);
  world.light = MakeLighting(options.light, &light_random);
  world.skyline = MakeSkyline(&light_random);
  Random surroundings_random = RandomOf(seed, LandingPart::kSurroundings);
  AddSurroundings(options.surroundings, track, &surroundings_random, &world);
  return scene;
}

}  // namespace kestrel
