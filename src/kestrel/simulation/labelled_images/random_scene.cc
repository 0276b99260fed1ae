// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/labelled_images/random_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/labelled_images/shadow_casters.h"
#include "kestrel/simulation/scene/direction.h"
#include "kestrel/simulation/scene/landing_drawings.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

// The shadow of a UAV: body, four arms, four rotors.
Drawing UavShadow(const Vector2d& center, double size_m, Random* random) {
  const Vector2d forward = RandomDirection(random);
  const Vector2d left(-forward.y(), forward.x());
  Drawing shadow;
  shadow.Add(Drawing::Bar{center, forward, 0.25 * size_m, 0.15 * size_m});
  for (const Vector2d& arm : {forward, left, Vector2d(-forward), Vector2d(-left)}) {
    shadow.Add(Drawing::Bar{center + 0.3 * size_m * arm, arm, 0.3 * size_m, 0.03 * size_m});
    shadow.Add(Drawing::Ring{center + 0.6 * size_m * arm, 0.25 * size_m});
  }
  return shadow;
}

// The shadow of a large thing whose edge passes within 'reach_m' of the origin.
Drawing ShadowEdge(double reach_m, Random* random) {
  constexpr double kHalfSize = 500;
  const Vector2d outward = RandomDirection(random);
  const double distance = random->Uniform(-reach_m, reach_m);
  return Drawing().Add(
      Drawing::Bar{(distance + kHalfSize) * outward, outward, kHalfSize, kHalfSize});
}

// Adds a mirror image of the sun that washes out a part of the pattern.
void AddGlare(const Vector2d& around, double radius_m, Random* random, Scene* scene) {
  const Vector2d center = around + radius_m * random->Uniform(0.5, 1.6) * RandomDirection(random);
  scene->glares.push_back(
      {center, radius_m * random->Uniform(0.15, 0.35), random->Uniform(0.3, 1.5)});
}

// Adds white lines on the ground, straight across the scene.
void AddMarkings(Random* random, Scene* scene) {
  const int count = random->Integer(0, 4);
  for (int i = 0; i < count; ++i) {
    const Vector2d axis = RandomDirection(random);
    const Vector2d across(-axis.y(), axis.x());
    const Vector2d center = random->Uniform(-8, 8) * across;
    scene->layers.push_back({Drawing().Add(Drawing::Bar{center, axis, random->Uniform(3, 40),
                                                        random->Uniform(0.05, 0.2)}),
                             random->Uniform(0.5, 0.9), 0.15});
  }
}

// Adds the roof of the vehicle that carries the board, and parts of it.
void AddVehicle(double board_size_m, Random* random, Scene* scene) {
  const Vector2d axis =
      random->Chance(0.7) ? Vector2d(Vector2d(1, 1).normalized()) : RandomDirection(random);
  const Vector2d center = random->Uniform(-0.6, 0.6) * axis;
  const double half_width = board_size_m * random->Uniform(0.45, 0.7);
  const double half_length = board_size_m * random->Uniform(0.6, 1.6);
  const double reflectance =
      random->Chance(0.5) ? random->Uniform(0.03, 0.2) : random->Uniform(0.4, 0.85);
  scene->layers.push_back(
      {Drawing().Add(Drawing::Bar{center, axis, half_length, half_width}), reflectance, 0.1});
  const Vector2d window = center + 0.8 * half_length * axis;
  scene->layers.push_back(
      {Drawing().Add(Drawing::Bar{window, axis, 0.12 * half_length, 0.8 * half_width}),
       random->Uniform(0.02, 0.3), 0.1});
}

}  // namespace

Scene RandomGround(Random* random) {
  Scene scene;
  scene.ground_reflectance = random->Uniform(0.06, 0.45);
  scene.ground_texture = random->Uniform(0.1, 0.6);
  scene.sky_radiance = random->Uniform(0.7, 1.4);
  scene.texture_seed = random->Bits();
  AddMarkings(random, &scene);
  return scene;
}

void AddRandomPattern(const LandingPattern& pattern, Random* random, Scene* scene) {
  if (random->Chance(0.6)) AddVehicle(pattern.board_size_m, random, scene);
  const double paper = random->Uniform(0.75, 0.95);
  const double dirt = random->Uniform(0, 0.12);
  // The arms of the cross point to the corners of the board.
  scene->layers.push_back({SquareBoard({0, 0}, pattern.board_size_m, kPi / 4), paper, dirt});
  Drawing ink = LandingPatternInk(pattern);
  if (random->Chance(0.3)) {
    WearInk({0, 0}, pattern.outer_radius_m(), random->Integer(2, 15), random, &ink);
  }
  scene->layers.push_back({ink, random->Uniform(0.03, 0.15), dirt});
}

// A stain is a trail of round spots of decreasing size: dark dirt, pale dust, or bare white.
void AddRandomWear(const Vector2d& center, double radius_m, double wear, Random* random,
                   Scene* scene) {
  constexpr double kMostStains = 9, kReach = 1.2;
  if (wear == 0) return;
  const auto stains = static_cast<int>(std::lround(wear * random->Uniform(0.3, 1) * kMostStains));
  for (int i = 0; i < stains; ++i) {
    const double distance_m = kReach * radius_m * std::sqrt(random->Uniform());
    Vector2d place = center + distance_m * RandomDirection(random);
    const Vector2d drift = RandomDirection(random);
    double size_m = radius_m * random->Uniform(0.03, 0.11);
    Drawing stain;
    for (int spots = random->Integer(2, 9); spots > 0; --spots, size_m *= 0.9) {
      stain.Add(Drawing::Ring{place, size_m});
      place += size_m * (drift + RandomDirection(random));
    }
    const double reflectance =
        random->Chance(0.4) ? random->Uniform(0.1, 0.35) : random->Uniform(0.45, 0.9);
    scene->layers.push_back({stain, reflectance, random->Uniform(0.1, 0.4)});
  }
}

const char* AddRandomLookalike(const Vector2d& center, double radius_m, LookalikeSet set,
                               Random* random, Scene* scene) {
  const auto kinds = Lookalikes(set);
  const Lookalike& kind = kinds[random->Integer(0, static_cast<int>(kinds.size()) - 1)];
  const double yaw = random->Uniform(0, 2 * kPi);
  Drawing ink = kind.draw(center, radius_m, yaw, random);
  if (random->Chance(0.2)) WearInk(center, radius_m, 6, random, &ink);
  const double style = random->Uniform();
  const double dirt = random->Uniform(0, 0.12);
  double paper = random->Uniform(0.7, 0.95);
  double paint = random->Uniform(0.03, 0.2);
  if (style < 0.2) std::swap(paper, paint);
  if (style < 0.85) {
    const double size = radius_m * random->Uniform(2.1, 3.0);
    scene->layers.push_back({SquareBoard(center, size, yaw + kPi / 4), paper, dirt});
  } else {
    paint = scene->ground_reflectance > 0.3 ? 0.05 : 0.85;
  }
  scene->layers.push_back({ink, paint, dirt});
  return kind.name;
}

namespace {

void AddMixedShadow(double reach_m, Random* random, Scene* scene) {
  const double kind = random->Uniform();
  if (kind < 0.18) {
    scene->shadows.push_back({ShadowEdge(reach_m, random), random->Uniform(0.35, 0.75)});
  } else if (kind < 0.3) {
    const Vector2d center = reach_m * random->Uniform() * RandomDirection(random);
    scene->shadows.push_back(
        {UavShadow(center, random->Uniform(0.4, 0.9), random), random->Uniform(0.35, 0.75), 0.01});
  }
}

std::span<const ShadowCaster> CastersOf(StillCondition condition) {
  switch (condition) {
    case StillCondition::kUavShadow:
      return UavShadowCasters();
    case StillCondition::kOtherShadow:
      return SurroundingShadowCasters();
    case StillCondition::kHeldOutShadow:
      return HeldOutShadowCasters();
    default:
      return {};
  }
}

// Adds a broad highlight that leaves some contrast on a part of the board, and smaller ones.
void AddLowSun(const StillLight& light, Random* random, Scene* scene) {
  const double radius_m = light.radius_m;
  const double distance = radius_m * random->Uniform(0, 1.6);
  const Vector2d center = light.center + distance * RandomDirection(random);
  const double sigma_m = radius_m * 0.5 * std::pow(8, random->Uniform());
  scene->glares.push_back({center, sigma_m, random->Uniform(0.2, 0.85)});
  for (int i = random->Integer(0, 3); i > 0; --i) AddGlare(light.center, radius_m, random, scene);
}

// Standard deviation of the noise, as a share of the contrast.
double RandomNoise(const StillLight& light, Random* random) {
  if (light.condition == StillCondition::kNight) return random->Uniform(0.12, 0.3);
  // The noise that the eye can see through increases with the size.
  const double most = light.condition == StillCondition::kDark
                          ? std::clamp(0.003 * light.size_px, 0.05, 0.15)
                          : 0.018;
  return random->Uniform(0.003, most);
}

double RandomContrast(StillCondition condition, Random* random) {
  switch (condition) {
    case StillCondition::kDark:
      return 12 * std::pow(5, random->Uniform());
    case StillCondition::kNight:
      return random->Uniform(16, 36);
    case StillCondition::kGlare:
      return random->Uniform(150, 250);
    case StillCondition::kMixed:
      return random->Chance(0.15) ? random->Uniform(50, 90) : random->Uniform(90, 250);
    default:
      return random->Uniform(90, 250);
  }
}

}  // namespace

void AddRandomShadows(const StillLight& light, Random* random, Scene* scene) {
  if (light.condition == StillCondition::kMixed) {
    AddMixedShadow(light.shadow_reach_m, random, scene);
    return;
  }
  const std::span<const ShadowCaster> casters = CastersOf(light.condition);
  if (casters.empty()) return;
  const int last = static_cast<int>(casters.size()) - 1;
  const int index = light.shadow_caster < 0 ? random->Integer(0, last) : light.shadow_caster;
  const SunLight sun{light.center, light.height_m, random->Uniform(0.25, 0.65)};
  scene->shadows = casters[index].cast(sun, random);
}

void AddRandomGlares(const StillLight& light, Random* random, Scene* scene) {
  if (light.condition == StillCondition::kGlare) return AddLowSun(light, random, scene);
  if (light.condition == StillCondition::kMixed && random->Chance(0.1)) {
    AddGlare(light.center, light.radius_m, random, scene);
  }
}

ImagingOptions RandomImaging(const StillLight& light, Random* random) {
  ImagingOptions imaging;
  const StillCondition condition = light.condition;
  const double contrast = RandomContrast(condition, random);
  if (condition == StillCondition::kDust) {
    imaging.haze = random->Uniform(0.3, 0.7);
  } else if (condition == StillCondition::kMixed && random->Chance(0.25)) {
    imaging.haze = random->Uniform(0.1, 0.45);
  }
  imaging.haze_radiance = random->Uniform(0.4, 0.9);
  imaging.black_level = random->Uniform(0, condition == StillCondition::kNight ? 6 : 15);
  imaging.white_level = std::min(imaging.black_level + contrast, 255.0);
  imaging.gradient = random->Uniform(0, 0.5) * RandomDirection(random);
  const double most_blur_px = std::clamp(0.4 + 0.02 * light.size_px, 0.5, 1.0);
  imaging.blur_sigma_px = condition == StillCondition::kBlur
                              ? random->Uniform(1, 1 + 0.02 * std::min(light.size_px, 100.0))
                              : random->Uniform(0.4, most_blur_px);
  imaging.read_noise = (1 - imaging.haze) * contrast * RandomNoise(light, random);
  imaging.shot_noise = random->Uniform(0, 2);
  imaging.noise_seed = random->Bits();
  return imaging;
}

}  // namespace kestrel
