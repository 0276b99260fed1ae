// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/hunt_objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/scene/hunt_paint.h"
#include "kestrel/simulation/scene/solids.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDiscHeight_m = 0.012;
constexpr double kPostHeight_m = 0.14;  // height of the yellow discs, which ride on robots
constexpr double kOrangeDiameter_m = 0.5;
constexpr double kBarLength_m = 2;
constexpr double kBarWidth_m = 0.15;

// Free places, at least a distance apart.
class Places {
 public:
  Places(const Vector2d& half_area, Random* random) : half_area_(half_area), random_(random) {}

  Vector2d Next() {
    constexpr int kTries = 200;
    double distance = 1.6;
    Vector2d place(0, 0);
    for (int i = 0; i < kTries; ++i) {
      place = {random_->Uniform(-half_area_.x(), half_area_.x()),
               random_->Uniform(-half_area_.y(), half_area_.y())};
      const bool is_free = std::ranges::all_of(
          taken_, [&](const Vector2d& other) { return (other - place).norm() > distance; });
      if (is_free) break;
      distance *= 0.99;
    }
    taken_.push_back(place);
    return place;
  }

 private:
  Vector2d half_area_;
  Random* random_;
  std::vector<Vector2d> taken_;
};

// Adds the objects one after the other.
class Placer {
 public:
  Placer(const HuntObjectsOptions& options, const Vector2d& half_area, Random* random, World* world)
      : options_(options), random_(random), world_(world), places_(half_area, random) {}

  void AddColored(const std::string& color) {
    if (options_.shape == "cuboid") {
      AddCuboid(color);
    } else {
      AddDisc(color, options_.size_m);
    }
  }

  void AddDisc(const std::string& color, double diameter_m) {
    const Vector2d place = places_.Next();
    Vector3d center(place.x(), place.y(), kDiscHeight_m);
    BeginObject();
    AddRoundPlate(0, center, 0.5 * diameter_m, color);
    AddObject({.color = color,
               .shape = "disc",
               .size_m = diameter_m,
               .center = [center](double) { return center; },
               .half_size = Vector2d::Constant(0.5 * diameter_m)});
  }

  void AddMovingDisc() {
    const Vector2d home = places_.Next();
    const Path path = options_.yellow_path == "straight" ? Straight() : Wandering();
    const int body = static_cast<int>(world_->bodies.size());
    world_->bodies.push_back([=](double time_s) {
      return RigidTransform{Eigen::Quaterniond::Identity(),
                            Vector3d(home.x(), home.y(), 0) + path(time_s)};
    });
    const Motion motion = world_->bodies.back();
    const auto dark = PlainPaint(Gray(0.05), world_->channels);
    AddBox(body, {{0, 0, 0.06}, {0.06, 0.05, 0.06}}, dark, dark, world_);
    const Vector3d top(0, 0, kPostHeight_m);
    BeginObject();
    AddRoundPlate(body, top, 0.5 * options_.size_m, "yellow");
    AddObject({.color = "yellow",
               .shape = "disc",
               .size_m = options_.size_m,
               .center = [=](double time_s) { return Vector3d(motion(time_s) * top); },
               .half_size = Vector2d::Constant(0.5 * options_.size_m)});
  }

  void AddBar() {
    const Vector2d place = places_.Next();
    const double yaw = random_->Uniform(0, 2 * kPi);
    const int body = AddStanding(place, yaw);
    const auto paint =
        FadedPaint(random_->Uniform(0, options_.fading), "orange", world_->channels, random_);
    const double height = 0.08;
    BeginObject();
    AddBox(body, {{0, 0, 0.5 * height}, {0.5 * kBarLength_m, 0.5 * kBarWidth_m, 0.5 * height}},
           paint, paint, world_);
    Vector3d center(place.x(), place.y(), height);
    AddObject({.color = "orange",
               .shape = "bar",
               .size_m = kBarLength_m,
               .yaw = yaw,
               .center = [center](double) { return center; },
               .half_size = {0.5 * kBarLength_m, 0.5 * kBarWidth_m}});
  }

  void AddDistractor() {
    const Vector2d place = places_.Next();
    static constexpr std::array kColors = {"red", "green", "blue", "yellow", "orange"};
    const std::string color = kColors[random_->Integer(0, kColors.size() - 1)];
    const double half = random_->Uniform(0.08, 0.35);
    Surface& plate = AddPlate(
        0, {place.x(), place.y(), kDiscHeight_m}, half, half * random_->Uniform(0.6, 1),
        random_->Uniform(0, 2 * kPi),
        FadedPaint(random_->Uniform(0, options_.fading), color, world_->channels, random_), world_);
    plate.mask = DistractorMask(random_);
    Gloss(&plate);
  }

  std::vector<HuntObject> objects;

 private:
  void AddCuboid(const std::string& color) {
    const Vector2d place = places_.Next();
    const double yaw = random_->Uniform(0, 2 * kPi);
    const int digit = static_cast<int>(objects.size()) % 10;
    const int body = AddStanding(place, yaw);
    const double half = 0.5 * options_.size_m;
    const double fading = random_->Uniform(0, options_.fading);
    const auto side = FadedPaint(fading, color, world_->channels, random_);
    const auto top = DigitPaint(fading, color, digit, world_->channels, random_);
    BeginObject();
    AddBox(body, {{0, 0, half}, {half, half, half}}, top, side, world_);
    Vector3d center(place.x(), place.y(), options_.size_m);
    AddObject({.color = color,
               .shape = "cuboid",
               .size_m = options_.size_m,
               .digit = digit,
               .yaw = yaw,
               .center = [center](double) { return center; },
               .half_size = Vector2d::Constant(half)});
  }

  Path Wandering() {
    // The speed of sines with about this period and amplitude is about the wanted one.
    constexpr double kPeriod_s = 14;
    const double sigma = options_.yellow_speed_mps * kPeriod_s / (2 * kPi);
    const auto x = Wander(sigma / std::numbers::sqrt2, kPeriod_s, random_);
    const auto y = Wander(sigma / std::numbers::sqrt2, kPeriod_s, random_);
    return [=](double time_s) { return Vector3d(x(time_s), y(time_s), 0); };
  }

  Path Straight() {
    const double course = random_->Uniform(0, 2 * kPi);
    const Vector3d velocity =
        options_.yellow_speed_mps * Vector3d(std::cos(course), std::sin(course), 0);
    return [=](double time_s) { return Vector3d(time_s * velocity); };
  }

  int AddStanding(const Vector2d& place, double yaw) {
    world_->bodies.push_back(Standing(place, yaw));
    return static_cast<int>(world_->bodies.size()) - 1;
  }

  void AddRoundPlate(int body, const Vector3d& center, double radius, const std::string& color) {
    Surface& plate = AddPlate(
        body, center, radius, radius, random_->Uniform(0, 2 * kPi),
        FadedPaint(random_->Uniform(0, options_.fading), color, world_->channels, random_), world_);
    plate.round = true;
    Gloss(&plate);
  }

  void Gloss(Surface* surface) {
    surface->gloss = static_cast<float>(random_->Uniform(0, options_.gloss));
    surface->gloss_width = static_cast<float>(random_->Uniform(0.2, 0.5));
  }

  // Called before its surfaces are added.
  void BeginObject() { first_surface_ = world_->surfaces.size(); }

  void AddObject(HuntObject object) {
    object.first_surface = first_surface_;
    object.last_surface = world_->surfaces.size();
    object.id = static_cast<int>(objects.size()) + 1;
    objects.push_back(std::move(object));
  }

  const HuntObjectsOptions& options_;
  Random* random_;
  World* world_;
  Places places_;
  std::size_t first_surface_ = 0;
};

}  // namespace

std::vector<HuntObject> AddHuntObjects(const HuntObjectsOptions& options, const Vector2d& half_area,
                                       Random* random, World* world) {
  Placer placer(options, half_area, random, world);
  for (int i = 0; i < std::max({options.red, options.green, options.blue}); ++i) {
    if (i < options.red) placer.AddColored("red");
    if (i < options.green) placer.AddColored("green");
    if (i < options.blue) placer.AddColored("blue");
  }
  for (int i = 0; i < options.yellow; ++i) placer.AddMovingDisc();
  for (int i = 0; i < options.orange; ++i) placer.AddDisc("orange", kOrangeDiameter_m);
  for (int i = 0; i < options.orange_bars; ++i) placer.AddBar();
  for (int i = 0; i < options.distractors; ++i) placer.AddDistractor();
  return std::move(placer.objects);
}

}  // namespace kestrel
