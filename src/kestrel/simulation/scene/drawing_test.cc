// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/drawing.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/landing_drawings.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

TEST(DrawingTest, RingHasTwoEdges) {
  const Drawing ring = Drawing().Add(Drawing::Ring{{1, 2}, 0.5, 0.4});
  EXPECT_NEAR(ring.NearestEdge({1.7, 2}).distance, 0.2, 1e-12);
  EXPECT_NEAR(ring.NearestEdge({1, 2.47}).distance, -0.03, 1e-12);
  EXPECT_NEAR(ring.NearestEdge({1, 2.3}).distance, 0.1, 1e-12);
  EXPECT_NEAR(ring.NearestEdge({1, 2.3}).normal.y(), -1, 1e-12);  // the ink lies outwards
  EXPECT_NEAR(ring.NearestEdge({1, 2}).distance, 0.4, 1e-12);
}

TEST(DrawingTest, BarIsRotatedRectangle) {
  const Vector2d axis = Vector2d(3, 4) / 5;
  const Drawing bar = Drawing().Add(Drawing::Bar{{1, 1}, axis, 2, 0.5});
  EXPECT_NEAR(bar.NearestEdge(Vector2d(1, 1) + 2.25 * axis).distance, 0.25, 1e-12);
  EXPECT_NEAR(bar.NearestEdge(Vector2d(1, 1)).distance, -0.5, 1e-12);
  const Vector2d across(-axis.y(), axis.x());
  const Vector2d beyond_corner = Vector2d(1, 1) + (2 + 0.3) * axis + (0.5 + 0.4) * across;
  EXPECT_NEAR(bar.NearestEdge(beyond_corner).distance, 0.5, 1e-12);
}

TEST(DrawingTest, ErasedAreaIsOutside) {
  Drawing drawing = Drawing().Add(Drawing::Ring{{0, 0}, 1});
  drawing.Erase(Drawing::Bar{{0, 0}, {1, 0}, 0.5, 0.1});
  EXPECT_NEAR(drawing.NearestEdge({0, 0}).distance, 0.1, 1e-12);
  EXPECT_LT(drawing.NearestEdge({0, 0.5}).distance, 0);
  drawing.Add(Drawing::Ring{{0, 0}, 0.05});
  EXPECT_NEAR(drawing.NearestEdge({0, 0}).distance, -0.05, 1e-12);
}

TEST(DrawingTest, EmptyDrawingIsNowhere) { EXPECT_GT(Drawing().NearestEdge({0, 0}).distance, 1e9); }

std::vector<Lookalike> AllLookalikes() {
  const auto trained = Lookalikes(LookalikeSet::kWithCounterfeits);
  std::vector<Lookalike> all(trained.begin(), trained.end());
  const auto held_out = Lookalikes(LookalikeSet::kHeldOut);
  all.insert(all.end(), held_out.begin(), held_out.end());
  return all;
}

// The renderer uses a single ray where the edge is farther away than the size of the pixel.
TEST(DrawingTest, NearestEdgeIsLowerBound) {
  Random random(3);
  for (const Lookalike& kind : AllLookalikes()) {
    const Drawing drawing = kind.draw({0.5, -0.2}, 1, 0.3, &random);
    for (int i = 0; i < 2000; ++i) {
      const Vector2d point(random.Uniform(-3, 3), random.Uniform(-3, 3));
      const double distance = drawing.NearestEdge(point).distance;
      const double angle = random.Uniform(0, 6.3);
      const Vector2d moved =
          point + 0.999 * std::abs(distance) * Vector2d(std::cos(angle), std::sin(angle));
      EXPECT_EQ(drawing.NearestEdge(moved).distance < 0, distance < 0) << kind.name;
    }
  }
}

// Returns the part of the ink that two drawings share.
double Overlap(const Drawing& a, const Drawing& b, double radius) {
  int both = 0;
  int any = 0;
  for (double x = -radius; x < radius; x += radius / 40) {
    for (double y = -radius; y < radius; y += radius / 40) {
      const bool in_a = a.NearestEdge({x, y}).distance < 0;
      const bool in_b = b.NearestEdge({x, y}).distance < 0;
      both += in_a && in_b;
      any += in_a || in_b;
    }
  }
  return static_cast<double>(both) / any;
}

TEST(LandingDrawingsTest, NoLookalikeEqualsLandingPattern) {
  Random random(5);
  const LandingPattern pattern;
  const Drawing ink = LandingPatternInk(pattern);
  EXPECT_NEAR(Overlap(ink, ink, 0.5), 1, 1e-12);
  for (const Lookalike& kind : AllLookalikes()) {
    for (double yaw = 0; yaw < 1.57; yaw += 0.05) {
      const Drawing other = kind.draw({0, 0}, pattern.outer_radius_m(), yaw, &random);
      EXPECT_LT(Overlap(ink, other, 0.55), 0.9) << kind.name << " at yaw " << yaw;
    }
  }
}

TEST(LandingDrawingsTest, LookalikesStayInTheirCircle) {
  Random random(7);
  for (const Lookalike& kind : AllLookalikes()) {
    const Drawing ink = kind.draw({2, 1}, 0.4, 1, &random);
    for (double angle = 0; angle < 6.3; angle += 0.02) {
      const Vector2d point = Vector2d(2, 1) + 0.45 * Vector2d(std::cos(angle), std::sin(angle));
      EXPECT_GT(ink.NearestEdge(point).distance, 0) << kind.name;
    }
  }
}

TEST(LandingDrawingsTest, WearOnlyRemovesInk) {
  Random random(11);
  const Drawing whole = LandingPatternInk(LandingPattern());
  Drawing worn = whole;
  WearInk({0, 0}, 0.5, 20, &random, &worn);
  int lost = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vector2d point(random.Uniform(-0.6, 0.6), random.Uniform(-0.6, 0.6));
    const bool was_ink = whole.NearestEdge(point).distance < 0;
    const bool is_ink = worn.NearestEdge(point).distance < 0;
    EXPECT_TRUE(was_ink || !is_ink);
    lost += was_ink && !is_ink;
  }
  EXPECT_GT(lost, 10);
}

}  // namespace
}  // namespace kestrel
