// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/labelled_images/shadow_casters.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/scene/direction.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Shadows = std::vector<Shadow>;

constexpr double kSunDiameter = 0.0093;  // rad

// Returns a point within a circle, denser towards the middle.
Vector2d RandomPoint(double radius, Random* random) {
  const double distance = radius * random->Uniform();
  return distance * RandomDirection(random);
}

// Draws the shadow of one thing, in a frame of its own.
class ShadowPen {
 public:
  // 'reach_m': distance from the middle of the light. 'height_m': of the thing that casts the
  // shadow.
  ShadowPen(double reach_m, double height_m, const SunLight& sun, Random* random)
      : random_(*random),
        center_(sun.center + RandomPoint(reach_m, random)),
        yaw_(random->Uniform(0, 2 * kPi)),
        penumbra_m_(kSunDiameter * height_m * random->Uniform(1, 2.5)),  // longer for a low sun
        ambient_(sun.ambient) {}

  Random& random() { return random_; }

  Drawing::Ring Ring(const Vector2d& at, double outer, double inner = 0) const {
    return {Place(at), outer, inner};
  }
  // Returns a bar from one point to another.
  Drawing::Bar Bar(const Vector2d& from, const Vector2d& to, double width) const {
    const Vector2d start = Place(from), along = Place(to) - start;
    const double length = std::max(along.norm(), 1e-6);
    return {start + 0.5 * along, along / length, 0.5 * length, 0.5 * width};
  }

  void Cast(const Drawing& shape) { Cast(shape, ambient_); }
  void Cast(const Drawing& shape, double transmission) {
    shadows_.push_back({shape, transmission, penumbra_m_});
  }
  // Propellers: rotating discs, or blades that the exposure is too short to blur.
  void CastPropellers(std::span<const Vector2d> hubs, double radius) {
    const bool turning = random_.Chance(0.7);
    Drawing shape;
    for (const Vector2d& hub : hubs) {
      const Vector2d blade = radius * RandomDirection(&random_);
      if (turning) {
        shape.Add(Ring(hub, radius));
      } else {
        shape.Add(Bar(hub - blade, hub + blade, 0.12 * radius));
      }
    }
    Cast(shape, turning ? random_.Uniform(0.6, 0.92) : ambient_);
  }
  Shadows Take() { return std::move(shadows_); }

 private:
  Vector2d Place(const Vector2d& at) const {
    return center_ + at.x() * Direction(yaw_) + at.y() * Direction(yaw_ + 0.5 * kPi);
  }

  Random& random_;
  Vector2d center_;
  double yaw_;
  double penumbra_m_;
  double ambient_;
  Shadows shadows_;
};

constexpr double kUavReach = 0.6;  // m, from the middle of the pattern to that of a UAV's shadow

double UavSize(Random* random) { return 0.35 * std::pow(3.5, random->Uniform()); }  // m

// Hubs of 'count' rotors around the middle; the first one is at the angle 'first' (rad).
std::vector<Vector2d> Hubs(int count, double radius, double first) {
  std::vector<Vector2d> hubs;
  for (int i = 0; i < count; ++i) hubs.push_back(radius * Direction(first + 2 * kPi * i / count));
  return hubs;
}

void AddArms(const ShadowPen& pen, std::span<const Vector2d> hubs, double width, Drawing* shape) {
  for (const Vector2d& hub : hubs) {
    shape->Add(pen.Bar({0, 0}, hub, width)).Add(pen.Ring(hub, 1.3 * width));
  }
}

void AddSkids(ShadowPen* pen, double size, Drawing* shape) {
  const double side = size * pen->random().Uniform(0.2, 0.35), length = 0.35 * size;
  for (const double y : {side, -side}) {
    shape->Add(pen->Bar({-length, y}, {length, y}, 0.02 * size));
    for (const double x : {-0.5 * length, 0.5 * length}) {
      shape->Add(pen->Bar({x, y}, {0.3 * x, 0.3 * y}, 0.015 * size));
    }
  }
}

Shadows QuadcopterX(const SunLight& sun, Random* random) {
  ShadowPen pen(kUavReach, sun.height_m, sun, random);
  const double size = UavSize(random);
  const std::vector<Vector2d> hubs = Hubs(4, 0.5 * size, 0.25 * kPi);
  Drawing shape;
  shape.Add(pen.Bar({-0.16 * size, 0}, {0.16 * size, 0}, size * random->Uniform(0.14, 0.24)));
  AddArms(pen, hubs, size * random->Uniform(0.03, 0.06), &shape);
  if (random->Chance(0.5)) AddSkids(&pen, size, &shape);
  pen.Cast(shape);
  pen.CastPropellers(hubs, size * random->Uniform(0.18, 0.28));
  return pen.Take();
}

Shadows QuadcopterH(const SunLight& sun, Random* random) {
  ShadowPen pen(kUavReach, sun.height_m, sun, random);
  const double size = UavSize(random);
  const double x = size * random->Uniform(0.35, 0.5), y = size * random->Uniform(0.3, 0.45);
  const std::array<Vector2d, 4> hubs{Vector2d(x, y), {-x, y}, {-x, -y}, {x, -y}};
  const double width = size * random->Uniform(0.03, 0.06);
  Drawing shape;
  shape.Add(pen.Bar(hubs[0], hubs[1], width)).Add(pen.Bar(hubs[2], hubs[3], width));
  shape.Add(pen.Bar({0, -y}, {0, y}, size * random->Uniform(0.1, 0.3)));
  pen.Cast(shape);
  pen.CastPropellers(hubs, size * random->Uniform(0.16, 0.28));
  return pen.Take();
}

Shadows Hexacopter(const SunLight& sun, Random* random) {
  ShadowPen pen(kUavReach, sun.height_m, sun, random);
  const double size = UavSize(random);
  const std::vector<Vector2d> hubs = Hubs(6, 0.5 * size, random->Uniform(0, kPi / 6));
  Drawing shape;
  shape.Add(pen.Ring({0, 0}, size * random->Uniform(0.12, 0.2)));
  AddArms(pen, hubs, size * random->Uniform(0.02, 0.05), &shape);
  AddSkids(&pen, size, &shape);
  pen.Cast(shape);
  pen.CastPropellers(hubs, size * random->Uniform(0.14, 0.24));
  return pen.Take();
}

Shadows GuardedQuadcopter(const SunLight& sun, Random* random) {
  ShadowPen pen(kUavReach, sun.height_m, sun, random);
  const double size = UavSize(random);
  const std::vector<Vector2d> hubs = Hubs(4, 0.42 * size, 0.25 * kPi);
  const double guard = size * random->Uniform(0.22, 0.3);
  Drawing shape;
  shape.Add(pen.Bar({-0.2 * size, 0}, {0.2 * size, 0}, 0.26 * size));
  for (const Vector2d& hub : hubs) {
    shape.Add(pen.Bar({0, 0}, hub, 0.04 * size));
    pen.Cast(Drawing().Add(pen.Ring(hub, guard, 0.9 * guard)));
  }
  pen.Cast(shape);
  pen.CastPropellers(hubs, 0.88 * guard);
  return pen.Take();
}

Shadows VerticalPlane(const SunLight& sun, Random* random) {
  ShadowPen pen(kUavReach, sun.height_m, sun, random);
  const double span = random->Uniform(0.9, 2.2);
  const double x = 0.2 * span, y = 0.22 * span;
  const std::array<Vector2d, 4> hubs{Vector2d(x, y), {-x, y}, {-x, -y}, {x, -y}};
  Drawing shape;
  shape.Add(pen.Bar({0, -0.5 * span}, {0, 0.5 * span}, span * random->Uniform(0.09, 0.16)));
  shape.Add(pen.Bar({0.25 * span, 0}, {-0.35 * span, 0}, span * random->Uniform(0.05, 0.1)));
  shape.Add(pen.Bar({-0.35 * span, -0.15 * span}, {-0.35 * span, 0.15 * span}, 0.07 * span));
  shape.Add(pen.Bar(hubs[0], hubs[1], 0.02 * span)).Add(pen.Bar(hubs[2], hubs[3], 0.02 * span));
  pen.Cast(shape);
  pen.CastPropellers(hubs, span * random->Uniform(0.07, 0.12));
  return pen.Take();
}

// The region beyond a straight edge, like the shadow of a house or a hangar.
Shadows Edge(const SunLight& sun, Random* random) {
  ShadowPen pen(0.7, random->Uniform(0, 6), sun, random);
  constexpr double kFar = 500;
  pen.Cast(Drawing().Add(pen.Bar({0, 0}, {kFar, 0}, 2 * kFar)));
  return pen.Take();
}

Shadows Tree(const SunLight& sun, Random* random) {
  ShadowPen pen(0.8, random->Uniform(3, 12), sun, random);
  const int branches = random->Integer(12, 40);
  Drawing crown;
  for (int i = 0; i < branches; ++i) {
    const Vector2d at = RandomPoint(1.4, random);
    crown.Add(pen.Ring(at, random->Uniform(0.04, 0.25)));
  }
  pen.Cast(crown);
  return pen.Take();
}

Shadows Mast(const SunLight& sun, Random* random) {
  ShadowPen pen(0.5, random->Uniform(1, 10), sun, random);
  Drawing shape;
  shape.Add(pen.Bar({-20, 0}, {20, 0}, random->Uniform(0.02, 0.15)));
  for (int i = random->Integer(0, 3); i > 0; --i) {
    const double at = random->Uniform(-1, 1);
    const Vector2d stay{random->Uniform(-2, 2), random->Uniform(0.5, 3)};
    shape.Add(pen.Bar({at, 0}, {at + stay.x(), stay.y()}, random->Uniform(0.01, 0.04)));
  }
  pen.Cast(shape);
  return pen.Take();
}

Shadows Person(const SunLight& sun, Random* random) {
  ShadowPen pen(0.5, random->Uniform(0.5, 2), sun, random);
  const double lean = random->Uniform(-0.3, 0.3), raised = random->Uniform(-0.7, 0.7);
  Drawing shape;
  shape.Add(pen.Bar({-0.1, 0}, {0.55, lean * 0.3}, random->Uniform(0.3, 0.5)));
  shape.Add(pen.Ring({0.72, lean * 0.4}, 0.12));
  shape.Add(pen.Bar({-1.2, -0.1}, {0, -0.08}, 0.16)).Add(pen.Bar({-1.2, 0.12}, {0, 0.08}, 0.16));
  shape.Add(pen.Bar({0.45, 0.2}, {0.45 + raised, 0.6}, 0.1));
  pen.Cast(shape);
  return pen.Take();
}

Shadows Fence(const SunLight& sun, Random* random) {
  ShadowPen pen(0.3, random->Uniform(0.5, 3), sun, random);
  const double step = random->Uniform(0.12, 0.5), width = step * random->Uniform(0.1, 0.4);
  Drawing shape;
  for (double y = -1.5; y <= 1.5; y += step) shape.Add(pen.Bar({-3, y}, {3, y}, width));
  pen.Cast(shape);
  return pen.Take();
}

Shadows VehicleParts(const SunLight& sun, Random* random) {
  ShadowPen pen(0.9, random->Uniform(0.1, 0.8), sun, random);
  Drawing rack;
  rack.Add(pen.Bar({-1.2, 0}, {1.2, 0}, random->Uniform(0.03, 0.1)));
  rack.Add(pen.Bar({0.4, -0.8}, {0.4, 0.8}, random->Uniform(0.02, 0.06)));
  rack.Add(pen.Bar({-0.5, 0.1}, {-0.9, 1.1}, random->Uniform(0.01, 0.03)));
  pen.Cast(rack);
  if (random->Chance(0.5)) {
    pen.Cast(Drawing().Add(pen.Bar({0.9, -1}, {0.9, 1}, random->Uniform(0.2, 0.7))));
  }
  return pen.Take();
}

Shadows Helicopter(const SunLight& sun, Random* random) {
  ShadowPen pen(kUavReach, sun.height_m, sun, random);
  const double size = random->Uniform(0.6, 1.6);
  const Vector2d blade = 0.5 * size * RandomDirection(random);
  Drawing shape;
  shape.Add(pen.Ring({0, 0}, 0.13 * size)).Add(pen.Ring({0.12 * size, 0}, 0.1 * size));
  shape.Add(pen.Bar({0, 0}, {-0.6 * size, 0}, 0.04 * size));
  shape.Add(pen.Ring({-0.6 * size, 0}, 0.09 * size, 0.075 * size));
  shape.Add(pen.Bar({-blade.x(), -blade.y()}, blade, 0.045 * size));
  AddSkids(&pen, 0.7 * size, &shape);
  pen.Cast(shape);
  pen.Cast(Drawing().Add(pen.Ring({0, 0}, 0.5 * size)), random->Uniform(0.75, 0.95));
  return pen.Take();
}

Shadows Octocopter(const SunLight& sun, Random* random) {
  ShadowPen pen(kUavReach, sun.height_m, sun, random);
  const double size = random->Uniform(0.7, 1.5);
  const std::vector<Vector2d> outer = Hubs(8, 0.5 * size, 0.2), inner = Hubs(8, 0.44 * size, 0.28);
  Drawing shape;
  shape.Add(pen.Bar({-0.14 * size, -0.1 * size}, {0.14 * size, 0.1 * size}, 0.2 * size));
  AddArms(pen, outer, 0.022 * size, &shape);
  for (const double y : {0.3 * size, -0.3 * size}) {
    shape.Add(pen.Bar({-0.6 * size, y}, {0.6 * size, 1.2 * y}, 0.03 * size));
  }
  pen.Cast(shape);
  pen.CastPropellers(outer, 0.17 * size);
  pen.CastPropellers(inner, 0.15 * size);
  return pen.Take();
}

Shadows LatticeMast(const SunLight& sun, Random* random) {
  ShadowPen pen(0.4, random->Uniform(2, 15), sun, random);
  const double half = random->Uniform(0.1, 0.3), width = random->Uniform(0.015, 0.04);
  Drawing shape;
  shape.Add(pen.Bar({-8, half}, {8, half}, width)).Add(pen.Bar({-8, -half}, {8, -half}, width));
  for (double x = -2; x < 2; x += 2 * half) {
    shape.Add(pen.Bar({x, -half}, {x + 2 * half, half}, width));
    shape.Add(pen.Bar({x, half}, {x + 2 * half, -half}, width));
  }
  pen.Cast(shape);
  return pen.Take();
}

Shadows Bush(const SunLight& sun, Random* random) {
  ShadowPen pen(0.6, random->Uniform(0.3, 3), sun, random);
  Drawing leaves;
  for (int i = random->Integer(30, 70); i > 0; --i) {
    const Vector2d at = RandomPoint(1, random);
    const double half_length = random->Uniform(0.03, 0.12);
    const Vector2d leaf = half_length * RandomDirection(random);
    leaves.Add(pen.Bar(at - leaf, at + leaf, random->Uniform(0.02, 0.07)));
  }
  pen.Cast(leaves);
  return pen.Take();
}

constexpr std::array kUavs = {
    ShadowCaster{"quadcopter in X", QuadcopterX},
    ShadowCaster{"quadcopter in H", QuadcopterH},
    ShadowCaster{"hexacopter", Hexacopter},
    ShadowCaster{"quadcopter with guards", GuardedQuadcopter},
    ShadowCaster{"vertical take-off plane", VerticalPlane},
};
constexpr std::array kSurroundings = {
    ShadowCaster{"edge", Edge},   ShadowCaster{"tree", Tree},
    ShadowCaster{"mast", Mast},   ShadowCaster{"person", Person},
    ShadowCaster{"fence", Fence}, ShadowCaster{"vehicle parts", VehicleParts},
};
constexpr std::array kHeldOut = {
    ShadowCaster{"helicopter", Helicopter},
    ShadowCaster{"octocopter", Octocopter},
    ShadowCaster{"lattice mast", LatticeMast},
    ShadowCaster{"bush", Bush},
};

}  // namespace

std::span<const ShadowCaster> UavShadowCasters() { return kUavs; }
std::span<const ShadowCaster> SurroundingShadowCasters() { return kSurroundings; }
std::span<const ShadowCaster> HeldOutShadowCasters() { return kHeldOut; }

}  // namespace kestrel
