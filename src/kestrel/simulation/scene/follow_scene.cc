// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/follow_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/hash.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/scene/direction.h"
#include "kestrel/simulation/scene/paint.h"
#include "kestrel/simulation/scene/solids.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

using Paint = std::shared_ptr<const Texture>;

// Each part has its own random numbers: options of one part do not change another.
enum class FollowPart { kLook = 300, kCrossing, kCover, kGround, kLight };
std::uint64_t SeedOf(std::uint64_t seed, FollowPart part) {
  return Hash(seed, static_cast<std::uint64_t>(part));
}
Random RandomOf(std::uint64_t seed, FollowPart part) { return Random(SeedOf(seed, part)); }

// Colour of clothes and paint: gray, or of any hue.
Color AnyColor(Random* random) {
  const double light = random->Uniform(0.03, 0.5);
  if (random->Chance(0.35)) return Gray(light);
  const double hue = random->Uniform(0, 2 * kPi);
  Color color;
  for (int i = 0; i < 3; ++i) color[i] = light * (1 + 0.9 * std::cos(hue + i * 2 * kPi / 3));
  return color;
}

// A colour with bands or a check of another one, or plain.
Paint Cloth(Random* random, int channels) {
  constexpr int kSize = 64;
  cv::Mat codes(kSize, kSize, CV_8UC3, CodesOf(AnyColor(random)));
  const cv::Scalar other = CodesOf(AnyColor(random));
  const int bands = random->Integer(0, 3);
  const bool is_level = random->Chance(0.5);
  for (int i = 0; i < bands; ++i) {
    const int at = kSize * (2 * i + 1) / (2 * bands + 1), wide = kSize / (2 * bands + 1);
    cv::rectangle(codes, is_level ? cv::Rect(0, at, kSize, wide) : cv::Rect(at, 0, wide, kSize),
                  other, cv::FILLED);
  }
  return std::make_shared<Texture>(codes, channels);
}

void AddPerson(int body, Random* random, World* world) {
  const int channels = world->channels;
  const double height = random->Uniform(1.6, 1.9), hip = 0.5 * height, neck = 0.85 * height;
  const Paint trousers = PlainPaint(AnyColor(random), channels);
  const Paint coat = Cloth(random, channels);
  const Paint hair = PlainPaint(AnyColor(random) * 0.5, channels);
  const Paint skin = PlainPaint(Color(0.2, 0.28, 0.4) * random->Uniform(0.4, 1.2), channels);
  for (const double side : {-1.0, 1.0}) {
    // A stride.
    AddBox(body, {{0.12 * side, 0.1 * side, 0.5 * hip}, {0.08, 0.08, 0.5 * hip}}, trousers,
           trousers, world);
  }
  AddBox(body, {{0, 0, 0.5 * (hip + neck)}, {0.14, 0.24, 0.5 * (neck - hip)}}, coat, coat, world);
  AddBox(body, {{0.02, 0, 0.5 * (neck + height)}, {0.1, 0.09, 0.5 * (height - neck)}}, hair, skin,
         world);
  if (random->Chance(0.4)) {
    const Paint bag = Cloth(random, channels);
    AddBox(body, {{-0.2, 0, 0.72 * height}, {0.08, 0.16, 0.2}}, bag, bag, world);
  }
}

// Something on the roof tells a car from others of its colour.
void AddMarkedCar(int body, Random* random, World* world) {
  const Color color = AnyColor(random);
  const bool is_pickup = random->Chance(0.3);
  const double roof =
      is_pickup ? AddPickup(body, color, random, world) : AddCar(body, color, random, world);
  AddPlate(body, {is_pickup ? 0.55 : -0.25, 0, roof + 0.01}, random->Uniform(0.3, 0.7),
           random->Uniform(0.3, 0.6), 0, Cloth(random, world->channels), world);
}

void AddBoat(int body, Random* random, World* world) {
  const int channels = world->channels;
  const double half_length = random->Uniform(2.2, 3.2), half_width = 0.36 * half_length;
  const Paint hull = PlainPaint(AnyColor(random), channels);
  AddBox(body, {{0, 0, 0.35}, {half_length, half_width, 0.35}}, Cloth(random, channels), hull,
         world);
  const Paint cabin = PlainPaint(Gray(random->Uniform(0.3, 0.8)), channels);
  AddBox(body, {{random->Uniform(-0.3, 0.4) * half_length, 0, 1.1}, {0.8, 0.7 * half_width, 0.4}},
         Cloth(random, channels), cabin, world);
}

// Adds one thing as its seed has it: twins have the same.
int AddThing(const std::string& kind, const Motion& motion, std::uint64_t seed, World* world) {
  const int body = static_cast<int>(world->bodies.size());
  world->bodies.push_back(motion);
  Random random(seed);
  if (kind == "person") AddPerson(body, &random, world);
  if (kind == "car") AddMarkedCar(body, &random, world);
  if (kind == "boat") AddBoat(body, &random, world);
  return body;
}

double LengthOf(const std::string& kind) {
  return kind == "person" ? 0.6 : (kind == "car" ? 4.8 : 6.4);
}

// Heading and speed of a thing at a time.
struct Course {
  Vector2d ahead;
  double speed_mps;
};
Course CourseAt(const Motion& thing, double time_s) {
  const Vector2d velocity = VelocityOf(thing, time_s).head<2>();
  const Vector2d nose = (thing(time_s).rotation * Vector3d::UnitX()).head<2>();
  constexpr double kMoving_mps = 0.05;
  const double speed = velocity.norm();
  return {speed > kMoving_mps ? velocity / speed : nose.normalized(), speed};
}

// Straight on across the way of a thing: at 'time_s' it passes near it, before it or behind it.
Motion Crossing(const std::string& kind, const Motion& thing, double time_s, Random* random) {
  const Course course = CourseAt(thing, time_s);
  const double side = random->Chance(0.5) ? 1 : -1, end = random->Chance(0.5) ? 1 : -1;
  const Vector2d across =
      Eigen::Rotation2Dd(side * Radians(random->Uniform(50, 130))) * course.ahead;
  const double gap_m = 1.1 * LengthOf(kind) + 0.3;
  const Vector2d place = Vector2d(thing(time_s).translation.head<2>()) + end * gap_m * course.ahead;
  const double least_mps = kind == "person" ? 1 : 3;
  const Vector2d velocity = std::max(course.speed_mps, least_mps) * across;
  const Eigen::Quaterniond rotation(
      Eigen::AngleAxisd(std::atan2(across.y(), across.x()), Vector3d::UnitZ()));
  return [=](double now_s) {
    const Vector2d at = place + (now_s - time_s) * velocity;
    return RigidTransform{rotation, {at.x(), at.y(), 0}};
  };
}

Paint Leaves(std::uint64_t seed, int channels) {
  constexpr int kSize_px = 256;
  const cv::Mat noise = FractalNoise({kSize_px, kSize_px}, 32, 4, 2, seed);
  return std::make_shared<Texture>(Painted({0.03, 0.1, 0.05}, 0.8, noise), channels);
}

// A crown with an irregular rim, in three layers, on its trunk.
void AddTree(const Vector3d& crown, double radius_m, Random* random, World* world) {
  const Paint bark = PlainPaint({0.03, 0.05, 0.08}, world->channels);
  AddBox(0, {{crown.x(), crown.y(), 0.5 * crown.z()}, {0.15, 0.15, 0.5 * crown.z()}}, bark, bark,
         world);
  for (int i = -1; i <= 1; ++i) {
    constexpr int kSize_px = 128;
    cv::Mat mask(kSize_px, kSize_px, CV_8UC1, cv::Scalar(0));
    std::vector<cv::Point> rim;
    for (int k = 0; k < 40; ++k) {
      const Vector2d at = random->Uniform(0.88, 1.0) * Direction(2 * kPi * k / 40);
      rim.emplace_back(64 + static_cast<int>(63 * at.x()), 64 + static_cast<int>(63 * at.y()));
    }
    cv::fillPoly(mask, std::vector<std::vector<cv::Point>>{rim}, cv::Scalar(255));
    const double half = i == 0 ? radius_m / 0.88 : 0.8 * radius_m;
    AddPlate(0, crown + Vector3d(0, 0, 0.7 * i), half, half, random->Uniform(0, kPi),
             Leaves(random->Bits(), world->channels), world)
        .mask = std::make_shared<Texture>(mask, 1);
  }
}

// A deck across the way, with its parapets.
void AddBridge(const Vector3d& middle, double yaw, double half_length_m, World* world) {
  constexpr double kHalfWidth_m = 25;
  const Paint road = PlainPaint(Gray(0.2), world->channels);
  const Paint parapet = PlainPaint(Gray(0.4), world->channels);
  const int body = static_cast<int>(world->bodies.size());
  world->bodies.push_back(Standing(middle.head<2>(), yaw));
  AddBox(body, {{0, 0, middle.z() - 0.3}, {half_length_m, kHalfWidth_m, 0.3}}, road, parapet,
         world);
}

// An invisible plate in the way of the sun.
void AddShade(const Vector3d& middle, double yaw, double half_length_m, World* world) {
  constexpr double kHalfWidth_m = 12;
  Surface& plate = AddPlate(0, middle, half_length_m, kHalfWidth_m, yaw, nullptr, world);
  plate.mask = std::make_shared<Texture>(cv::Mat(8, 8, CV_8UC1, cv::Scalar(255)), 1);
  plate.visible = false;
}

// Over the middle of the way for which it is covered, on the line from there to the eye or the sun.
void AddCover(const FollowedThingOptions& options, const Motion& thing, const Path& eye,
              Random* random, World* world) {
  const double time_s = options.cover_at_s + 0.5 * options.covered_s;
  const Course course = CourseAt(thing, time_s);
  const Vector3d below =
      thing(time_s).translation + Vector3d(0, 0, options.kind == "person" ? 0.9 : 0.6);
  const double half_m = 0.5 * (course.speed_mps * options.covered_s + LengthOf(options.kind));
  const double yaw = std::atan2(course.ahead.y(), course.ahead.x());
  const bool is_shade = options.cover == "shade";
  const Vector3d way = is_shade ? world->light.to_sun : Vector3d(eye(time_s) - below);
  const double height_m = is_shade ? 15 : 4.5;
  const Vector3d middle = below + (height_m - below.z()) / way.z() * way;
  if (is_shade) AddShade(middle, yaw, half_m, world);
  if (options.cover == "bridge") AddBridge(middle, yaw, half_m, world);
  if (options.cover == "tree") AddTree(middle, half_m, random, world);
}

}  // namespace

FollowScene MakeFollowScene(const FollowedThingOptions& options,
                            const FollowSurroundings& surroundings, const Motion& thing,
                            const Path& eye, int channels, std::uint64_t seed) {
  FollowScene scene;
  World& world = scene.world;
  world.channels = channels;
  const std::uint64_t look = SeedOf(seed, FollowPart::kLook);
  scene.thing = AddThing(options.kind, thing, look, &world);
  Random crossing_random = RandomOf(seed, FollowPart::kCrossing);
  for (int i = 0; i < options.lookalikes; ++i) {
    const double time_s = options.first_crossing_s + i * options.crossing_period_s;
    const Motion crossing = Crossing(options.kind, thing, time_s, &crossing_random);
    scene.lookalikes.push_back(AddThing(options.kind, crossing, look, &world));
  }
  Random ground_random = RandomOf(seed, FollowPart::kGround);
  world.ground = MakeGround(surroundings.ground, {}, channels, &ground_random);
  Random light_random = RandomOf(seed, FollowPart::kLight);
  world.light = MakeLighting(surroundings.light, &light_random);
  world.skyline = MakeSkyline(&light_random);
  Random cover_random = RandomOf(seed, FollowPart::kCover);
  if (options.cover != "none") AddCover(options, thing, eye, &cover_random, &world);
  return scene;
}

}  // namespace kestrel
