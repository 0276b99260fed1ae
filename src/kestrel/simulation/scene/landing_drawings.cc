// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/landing_drawings.h"

#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/scene/direction.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

// Draws in a frame of its own: origin in the centre, largest radius 1.
class Pen {
 public:
  Pen(const Vector2d& center, double radius, double yaw)
      : center_(center), radius_(radius), yaw_(yaw) {}

  Drawing::Ring Ring(double outer, double inner = 0) const {
    return {center_, outer * radius_, inner * radius_};
  }
  // A stroke around 'middle', along 'angle'.
  Drawing::Bar Bar(const Vector2d& middle, double angle, double half_length,
                   double half_width) const {
    const Vector2d turned = middle.x() * Direction(yaw_) + middle.y() * Direction(yaw_ + 0.5 * kPi);
    return {center_ + radius_ * turned, Direction(yaw_ + angle), half_length * radius_,
            half_width * radius_};
  }
  // A stroke from the centre outwards.
  Drawing::Bar Spoke(double angle, double length, double half_width) const {
    return Bar(0.5 * length * Direction(angle), angle, 0.5 * length, half_width);
  }

 private:
  Vector2d center_;
  double radius_;
  double yaw_;
};

double StrokeWidth(Random* random) { return random->Uniform(0.14, 0.22); }

Drawing RingOnly(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  return Drawing().Add(pen.Ring(1, 1 - StrokeWidth(random)));
}

Drawing Disc(const Vector2d& center, double radius, double yaw, Random*) {
  return Drawing().Add(Pen(center, radius, yaw).Ring(1));
}

Drawing DiscWithBar(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  return Drawing()
      .Add(pen.Ring(1))
      .Erase(pen.Bar({0, 0}, 0, random->Uniform(0.6, 0.8), random->Uniform(0.1, 0.2)));
}

Drawing Bullseye(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const int rings = random->Integer(2, 3);
  const double step = 1.0 / (rings + random->Uniform(0, 0.5));
  Drawing ink;
  for (int i = 0; i < rings; ++i) ink.Add(pen.Ring(1 - i * step, 1 - (i + 0.5) * step));
  if (random->Chance(0.5)) ink.Add(pen.Ring(0.2 * step));
  return ink;
}

Drawing WheelOf(const Pen& pen, std::initializer_list<double> spoke_angles, Random* random) {
  const double width = StrokeWidth(random);
  Drawing ink;
  ink.Add(pen.Ring(1, 1 - width));
  for (const double angle : spoke_angles) ink.Add(pen.Spoke(angle, 1 - 0.5 * width, 0.5 * width));
  return ink;
}

Drawing WheelOfThree(const Vector2d& center, double radius, double yaw, Random* random) {
  return WheelOf(Pen(center, radius, yaw), {0, 2 * kPi / 3, 4 * kPi / 3}, random);
}

Drawing WheelOfFive(const Vector2d& center, double radius, double yaw, Random* random) {
  const double step = 2 * kPi / 5;
  return WheelOf(Pen(center, radius, yaw), {0, step, 2 * step, 3 * step, 4 * step}, random);
}

Drawing WheelOfSix(const Vector2d& center, double radius, double yaw, Random* random) {
  const double step = kPi / 3;
  return WheelOf(Pen(center, radius, yaw), {0, step, 2 * step, 3 * step, 4 * step, 5 * step},
                 random);
}

Drawing WheelOfEight(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  Drawing ink;
  ink.Add(pen.Ring(1, 0.86));
  for (int i = 0; i < 8; ++i) ink.Add(pen.Spoke(i * kPi / 4, 0.9, random->Uniform(0.05, 0.06)));
  return ink;
}

Drawing PeaceSign(const Vector2d& center, double radius, double yaw, Random* random) {
  return WheelOf(Pen(center, radius, yaw), {0.5 * kPi, 1.25 * kPi, 1.5 * kPi, 1.75 * kPi}, random);
}

Drawing ProhibitionSign(const Vector2d& center, double radius, double yaw, Random* random) {
  return WheelOf(Pen(center, radius, yaw), {0, kPi}, random);
}

Drawing TInRing(const Vector2d& center, double radius, double yaw, Random* random) {
  return WheelOf(Pen(center, radius, yaw), {0, 0.5 * kPi, kPi}, random);
}

Drawing CrossOnly(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const double half_width = 0.5 * StrokeWidth(random);
  return Drawing()
      .Add(pen.Bar({0, 0}, 0, 1, half_width))
      .Add(pen.Bar({0, 0}, 0.5 * kPi, 1, half_width));
}

Drawing SkewCrossInRing(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const double half_angle = random->Uniform(0.45, kPi / 6);  // the arms cross at 52 to 60 degrees
  return Drawing()
      .Add(pen.Ring(1, 0.8))
      .Add(pen.Bar({0, 0}, half_angle, 0.76, 0.1))
      .Add(pen.Bar({0, 0}, -half_angle, 0.76, 0.1));
}

Drawing CrossBesideCenter(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const Vector2d middle(random->Uniform(0.26, 0.34), 0);
  return Drawing()
      .Add(pen.Ring(1, 0.8))
      .Add(pen.Bar(middle, 0.25 * kPi, 0.45, 0.1))
      .Add(pen.Bar(middle, -0.25 * kPi, 0.45, 0.1));
}

void AddLetterH(const Pen& pen, double size, double half_width, Drawing* ink) {
  ink->Add(pen.Bar({-0.6 * size, 0}, 0.5 * kPi, size, half_width))
      .Add(pen.Bar({0.6 * size, 0}, 0.5 * kPi, size, half_width))
      .Add(pen.Bar({0, 0}, 0, 0.6 * size, half_width));
}

Drawing HInRing(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  Drawing ink;
  ink.Add(pen.Ring(1, 1 - StrokeWidth(random)));
  AddLetterH(pen, 0.5, 0.09, &ink);
  return ink;
}

// Adds a frame around the inside, as wide as a stroke.
void AddFrame(const Pen& pen, double stroke, Drawing* ink) {
  const double half = std::numbers::sqrt2 / 2;
  ink->Add(pen.Bar({0, 0}, 0, half, half));
  ink->Erase(pen.Bar({0, 0}, 0, half - stroke, half - stroke));
}

Drawing HPad(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  Drawing ink;
  AddFrame(pen, random->Uniform(0.06, 0.12), &ink);
  AddLetterH(pen, 0.42, 0.09, &ink);
  return ink;
}

Drawing FrameWithCross(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const double stroke = StrokeWidth(random);
  Drawing ink;
  AddFrame(pen, stroke, &ink);
  ink.Add(pen.Bar({0, 0}, 0.25 * kPi, 0.8, 0.5 * stroke));
  ink.Add(pen.Bar({0, 0}, -0.25 * kPi, 0.8, 0.5 * stroke));
  return ink;
}

// Returns the centre of field (column, row) of 'fields' x 'fields' in the square inscribed in the
// circle.
Vector2d FieldCenter(int column, int row, int fields) {
  const double half = std::numbers::sqrt2 / 2;
  return Vector2d(2 * column + 1 - fields, 2 * row + 1 - fields) * (half / fields);
}

Drawing Chessboard(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const int fields = random->Integer(2, 6);
  const double half = std::numbers::sqrt2 / 2 / fields;
  Drawing ink;
  for (int i = 0; i < fields * fields; ++i) {
    const int column = i % fields;
    const int row = i / fields;
    if ((column + row) % 2 == 0) {
      ink.Add(pen.Bar(FieldCenter(column, row, fields), 0, half, half));
    }
  }
  return ink;
}

Drawing Grid(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const int fields = random->Integer(2, 5);
  const double half = std::numbers::sqrt2 / 2;
  const double half_pane = half / fields * random->Uniform(0.7, 0.9);
  Drawing ink;
  ink.Add(pen.Bar({0, 0}, 0, half, half));
  for (int i = 0; i < fields * fields; ++i) {
    ink.Erase(pen.Bar(FieldCenter(i % fields, i / fields, fields), 0, half_pane, half_pane));
  }
  return ink;
}

// Three spokes of a hub, two of them nearly in line.
Drawing SteeringWheel(const Vector2d& center, double radius, double yaw, Random* random) {
  const double droop = random->Uniform(-0.3, 0.3);
  Drawing ink = WheelOf(Pen(center, radius, yaw), {droop, 0.5 * kPi, kPi - droop}, random);
  return ink.Add(Pen(center, radius, yaw).Ring(random->Uniform(0.12, 0.3)));
}

Drawing CrossWithShortArm(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const double width = StrokeWidth(random);
  const double length = random->Uniform(0.7, 1) * (1 - width);
  Drawing ink;
  ink.Add(pen.Ring(1, 1 - width));
  for (int arm = 0; arm < 4; ++arm) {
    const double share = arm == 0 ? random->Uniform(0.2, 0.45) : 1;
    ink.Add(pen.Spoke(arm * 0.5 * kPi, share * length, 0.5 * width));
  }
  return ink;
}

// A cross whose arms are much thinner or much thicker than the ring.
Drawing OtherStrokes(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const double half_width =
      random->Chance(0.5) ? random->Uniform(0.02, 0.04) : random->Uniform(0.2, 0.3);
  return Drawing()
      .Add(pen.Ring(1, 0.8))
      .Add(pen.Bar({0, 0}, 0, 0.76, half_width))
      .Add(pen.Bar({0, 0}, 0.5 * kPi, 0.76, half_width));
}

// A cross that extends beyond its ring.
Drawing Crosshair(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const double ring = random->Uniform(0.5, 0.75);
  const double half_width = 0.5 * ring * StrokeWidth(random);
  return Drawing()
      .Add(pen.Ring(ring, ring - 2 * half_width))
      .Add(pen.Bar({0, 0}, 0, 1, half_width))
      .Add(pen.Bar({0, 0}, 0.5 * kPi, 1, half_width));
}

Drawing CrossInBullseye(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const double width = random->Uniform(0.1, 0.16);
  const double inner = random->Uniform(0.4, 0.6);
  return WheelOf(pen, {0, 0.5 * kPi, kPi, 1.5 * kPi}, random).Add(pen.Ring(inner, inner - width));
}

// A grating in a ring, as on a manhole.
Drawing Grating(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const int bars = random->Integer(2, 4);
  const double half_width = random->Uniform(0.25, 0.4) / bars;
  Drawing ink;
  ink.Add(pen.Ring(1, 1 - StrokeWidth(random)));
  for (int i = 0; i < bars; ++i) {
    const double across = (2 * i + 1 - bars) * 0.9 / bars;
    const double half_length = std::sqrt(0.85 - across * across);
    ink.Add(pen.Bar({0, across}, 0, half_length, half_width));
    if (random->Chance(0.5)) ink.Add(pen.Bar({across, 0}, 0.5 * kPi, half_length, half_width));
  }
  return ink;
}

// Letters that have strokes through the middle of a ring.
Drawing LetterInRing(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const double half_width = random->Uniform(0.07, 0.12);
  const double size = random->Uniform(0.45, 0.65);
  const auto bar = [&](double x, double y, double angle_deg, double half_length) {
    return pen.Bar(size * Vector2d(x, y), angle_deg * kPi / 180, size * half_length, half_width);
  };
  Drawing ink;
  ink.Add(pen.Ring(1, 1 - StrokeWidth(random)));
  switch (random->Integer(0, 5)) {
    case 0:  // K
      return ink.Add(bar(-0.5, 0, 90, 1)).Add(bar(0, 0.5, 45, 0.7)).Add(bar(0, -0.5, -45, 0.7));
    case 1:  // N
      return ink.Add(bar(-0.6, 0, 90, 1)).Add(bar(0.6, 0, 90, 1)).Add(bar(0, 0, 120, 1.1));
    case 2:  // Y
      return ink.Add(bar(0, -0.5, 90, 0.5))
          .Add(bar(0.35, 0.5, 55, 0.6))
          .Add(bar(-0.35, 0.5, 125, 0.6));
    case 3:  // F
      return ink.Add(bar(-0.4, 0, 90, 1)).Add(bar(0.1, 0.9, 0, 0.6)).Add(bar(0, 0.1, 0, 0.5));
    case 4:  // A
      return ink.Add(bar(-0.3, 0, 70, 1)).Add(bar(0.3, 0, 110, 1)).Add(bar(0, -0.3, 0, 0.5));
    default:  // 4
      return ink.Add(bar(0.3, 0, 90, 1)).Add(bar(0, -0.2, 0, 0.8)).Add(bar(-0.2, 0.4, 50, 0.8));
  }
}

// Adds the outline of a polygon whose corners lie on a circle.
void AddPolygon(const Pen& pen, int corners, double radius, double half_width, Drawing* ink) {
  const double half_turn = kPi / corners;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * half_turn * i;
    ink->Add(pen.Bar(radius * std::cos(half_turn) * Direction(angle), angle + 0.5 * kPi,
                     radius * std::sin(half_turn), half_width));
  }
}

Drawing PolygonInRing(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const double width = StrokeWidth(random);
  Drawing ink;
  ink.Add(pen.Ring(1, 1 - width));
  AddPolygon(pen, random->Integer(3, 8), random->Uniform(0.4, 0.85), 0.5 * width, &ink);
  return ink;
}

// The pattern's own cross without a ring.
Drawing CrossOfThePattern(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const double half_length = random->Uniform(0.7, 0.9);
  return Drawing()
      .Add(pen.Bar({0, 0}, 0, half_length, 0.1))
      .Add(pen.Bar({0, 0}, 0.5 * kPi, half_length, 0.1));
}

Drawing TriangleInRing(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  Drawing ink;
  ink.Add(pen.Ring(1, random->Uniform(0.78, 0.86)));
  AddPolygon(pen, 3, random->Uniform(0.75, 0.95), 0.09, &ink);
  return ink.Add(pen.Spoke(0, 0.5, 0.08));
}

Drawing StarInRing(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const int points = random->Integer(4, 6);
  Drawing ink;
  ink.Add(pen.Ring(1, random->Uniform(0.78, 0.86)));
  for (int i = 0; i < points; ++i) {
    ink.Add(pen.Spoke(2 * kPi * i / points, 0.7, 0.05 + 0.15 * random->Uniform()));
  }
  return ink.Add(pen.Ring(random->Uniform(0.2, 0.35)));
}

// A clock: hands at a right angle and twelve marks.
Drawing Clock(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  Drawing ink;
  ink.Add(pen.Ring(1, 0.84)).Add(pen.Spoke(0, 0.7, 0.07)).Add(pen.Spoke(0.5 * kPi, 0.5, 0.08));
  for (int i = 0; i < 12; ++i) {
    ink.Add(pen.Bar(0.72 * Direction(i * kPi / 6), i * kPi / 6, 0.1, 0.03));
  }
  return random->Chance(0.5) ? ink.Add(pen.Ring(0.12)) : ink;
}

// Bars that bend at right angles in a ring, as in a mirrored hooked cross or a maze.
Drawing BentCross(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  const double half_width = random->Uniform(0.07, 0.1), hook = random->Uniform(0.15, 0.3);
  Drawing ink;
  ink.Add(pen.Ring(1, 0.82));
  for (int i = 0; i < 2; ++i) {
    const double angle = 0.5 * kPi * i;
    ink.Add(pen.Bar({0, 0}, angle, 0.55, half_width));
    for (const double end : {0.55, -0.55}) {
      const Vector2d along = end * Direction(angle);
      ink.Add(pen.Bar(along + hook * Direction(angle + 0.5 * kPi), angle + 0.5 * kPi, hook,
                      half_width));
    }
  }
  return ink;
}

// A window of four panes: a cross that reaches a round frame, with a second frame around it.
Drawing RoundWindow(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  Drawing ink;
  ink.Add(pen.Ring(1, 0.9)).Add(pen.Ring(0.8, random->Uniform(0.66, 0.72)));
  const double half_width = random->Uniform(0.04, 0.09);
  return ink.Add(pen.Bar({0, 0}, 0, 0.75, half_width))
      .Add(pen.Bar({0, 0}, 0.5 * kPi, 0.75, half_width));
}

// Two arrows that meet at a right angle in a ring.
Drawing ArrowsInRing(const Vector2d& center, double radius, double yaw, Random* random) {
  const Pen pen(center, radius, yaw);
  Drawing ink;
  ink.Add(pen.Ring(1, random->Uniform(0.78, 0.86)));
  for (const double angle : {0.0, 0.5 * kPi}) {
    ink.Add(pen.Spoke(angle, 0.75, 0.08));
    for (const double turn : {0.75 * kPi, -0.75 * kPi}) {
      ink.Add(pen.Bar(0.65 * Direction(angle) + 0.14 * Direction(angle + turn), angle + turn, 0.2,
                      0.06));
    }
  }
  return ink;
}

constexpr std::array kLookalikes = {
    Lookalike{"ring", RingOnly},
    Lookalike{"disc", Disc},
    Lookalike{"disc with a bar", DiscWithBar},
    Lookalike{"bullseye", Bullseye},
    Lookalike{"wheel of three spokes", WheelOfThree},
    Lookalike{"wheel of five spokes", WheelOfFive},
    Lookalike{"wheel of six spokes", WheelOfSix},
    Lookalike{"wheel of eight spokes", WheelOfEight},
    Lookalike{"peace sign", PeaceSign},
    Lookalike{"prohibition sign", ProhibitionSign},
    Lookalike{"T in a ring", TInRing},
    Lookalike{"cross without ring", CrossOnly},
    Lookalike{"skew cross in a ring", SkewCrossInRing},
    Lookalike{"cross beside the centre of a ring", CrossBesideCenter},
    Lookalike{"H in a ring", HInRing},
    Lookalike{"H pad", HPad},
    Lookalike{"square frame with a cross", FrameWithCross},
    Lookalike{"chessboard", Chessboard},
    Lookalike{"grid", Grid},
    // Counterfeits
    Lookalike{"steering wheel", SteeringWheel},
    Lookalike{"cross with a short arm", CrossWithShortArm},
    Lookalike{"cross of other strokes", OtherStrokes},
    Lookalike{"crosshair", Crosshair},
    Lookalike{"cross in a bullseye", CrossInBullseye},
    Lookalike{"grating", Grating},
    Lookalike{"letter in a ring", LetterInRing},
    Lookalike{"polygon in a ring", PolygonInRing},
    Lookalike{"cross of the pattern", CrossOfThePattern},
};
constexpr std::size_t kCounterfeits = 9;

constexpr std::array kHeldOutLookalikes = {
    Lookalike{"triangle in a ring", TriangleInRing},
    Lookalike{"star in a ring", StarInRing},
    Lookalike{"clock", Clock},
    Lookalike{"bent cross in a ring", BentCross},
    Lookalike{"round window", RoundWindow},
    Lookalike{"arrows in a ring", ArrowsInRing},
};

}  // namespace

Drawing LandingPatternInk(const LandingPattern& pattern, const Vector2d& center, double yaw) {
  const double half_length = pattern.arm_half_length_m;
  const double half_width = 0.5 * pattern.arm_width_m;
  return Drawing()
      .Add(Drawing::Ring{center, pattern.outer_radius_m(), pattern.inner_radius_m()})
      .Add(Drawing::Bar{center, Direction(yaw), half_length, half_width})
      .Add(Drawing::Bar{center, Direction(yaw + 0.5 * kPi), half_length, half_width});
}

Drawing SquareBoard(const Vector2d& center, double size_m, double yaw) {
  return Drawing().Add(Drawing::Bar{center, Direction(yaw), 0.5 * size_m, 0.5 * size_m});
}

std::vector<Drawing::Shape> WornPlaces(const Vector2d& center, double radius_m, int patches,
                                       Random* random) {
  std::vector<Drawing::Shape> places;
  for (int i = 0; i < patches; ++i) {
    const Vector2d place =
        center + radius_m * std::sqrt(random->Uniform()) * Direction(random->Uniform(0, 2 * kPi));
    if (random->Chance(0.5)) {
      places.emplace_back(Drawing::Ring{place, radius_m * random->Uniform(0.01, 0.06)});
    } else {
      places.emplace_back(Drawing::Bar{place, Direction(random->Uniform(0, kPi)),
                                       radius_m * random->Uniform(0.05, 0.2),
                                       radius_m * random->Uniform(0.005, 0.015)});
    }
  }
  return places;
}

void WearInk(const Vector2d& center, double radius_m, int patches, Random* random, Drawing* ink) {
  for (const Drawing::Shape& place : WornPlaces(center, radius_m, patches, random)) {
    ink->Erase(place);
  }
}

std::span<const Lookalike> Lookalikes(LookalikeSet set) {
  switch (set) {
    case LookalikeSet::kPlain:
      return std::span(kLookalikes).first(kLookalikes.size() - kCounterfeits);
    case LookalikeSet::kWithCounterfeits:
      return kLookalikes;
    case LookalikeSet::kHeldOut:
      return kHeldOutLookalikes;
  }
  return {};
}

}  // namespace kestrel
