// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/candidates/ring_arcs.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/vision/landing/candidates/ring_fit.h"
#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

class FindArcRingsTest : public ::testing::Test {
 protected:
  const std::vector<ArcRing>& Find(const Print& is_dark, double min_coverage = 0.25) {
    const BorderTracer tracer = TraceFigure(is_dark, 320, 240);
    workspace_.Reserve(tracer.capacity());
    const double tolerance = 0.7 / camera_.intrinsics().fx_px;
    FindArcRings(tracer, tracer.borders(), rays_, {}, tolerance, min_coverage, &workspace_);
    return workspace_.rings;
  }
  static bool OnRing(double x, double y) {
    const double r = std::hypot(x - 150, y - 110);
    return r > 48 && r < 60;
  }
  void ExpectCircle(const ArcRing& ring) const {
    const double radius_px = ring.edge == RingEdge::kOuter ? 60 : 48;
    Eigen::Vector3d expected;
    camera_.Unproject({150, 110}, &expected);
    const auto poses = CirclePosesFromCone(ring.cone, 1, ring.toward);
    EXPECT_LT((poses[0].center.normalized() - expected).norm() * 220, 2) << "pixels";
    EXPECT_NEAR(std::tan(ring.cone.HalfAngles().x()) * 220, radius_px, 2.5);
  }

  const CameraModel camera_ = TestPrintCamera();
  const RayTable rays_{camera_};
  RingArcsWorkspace workspace_;
};

TEST_F(FindArcRingsTest, FindsNoArcsWithoutCapacity) {
  const BorderTracer tracer = TraceFigure(OnRing, 320, 240);
  workspace_.Reserve(300);  // the outer edge alone has more points
  const std::size_t room = workspace_.points.capacity();
  FindArcRings(tracer, tracer.borders(), rays_, {}, 0.003, 0.25, &workspace_);
  EXPECT_LE(workspace_.points.size(), room);
  EXPECT_EQ(workspace_.points.capacity(), room);
}

TEST_F(FindArcRingsTest, CoversWholeRing) {
  const auto& rings = Find(OnRing);
  ASSERT_EQ(rings.size(), 2u) << "its two edges";
  for (const ArcRing& ring : rings) {
    EXPECT_GT(ring.coverage, 0.9);
    ExpectCircle(ring);
  }
}

TEST_F(FindArcRingsTest, JoinsArcsOfBrokenRing) {
  // Cut by a wedge and by a bar: three arcs of each edge.
  const auto& rings = Find([](double x, double y) {
    return OnRing(x, y) && std::abs(y - 130) > 5 &&
           !(x > 150 && std::abs(x - 150) > y - 100 && y > 100 && y < 125);
  });
  ASSERT_FALSE(rings.empty());
  EXPECT_GT(rings[0].coverage, 0.6);
  for (const ArcRing& ring : rings) ExpectCircle(ring);
}

TEST_F(FindArcRingsTest, FindsRingMergedWithOtherFigure) {
  const auto& rings = Find([](double x, double y) {
    return OnRing(x, y) || (x > 150 && x < 300 && y > 160 && y < 230);
  });
  bool outer = false;
  for (const ArcRing& ring : rings) {
    if (ring.edge != RingEdge::kOuter) continue;
    outer = true;
    ExpectCircle(ring);
    EXPECT_LT(ring.coverage, 0.95);
  }
  EXPECT_TRUE(outer);
}

TEST_F(FindArcRingsTest, RequiresMinimumCoverage) {
  // A third of the ring.
  const Print third = [](double x, double y) { return OnRing(x, y) && y < 82; };
  const auto& rings = Find(third, 0.6);
  EXPECT_TRUE(rings.empty());
  ASSERT_FALSE(Find(third, 0.2).empty());
  EXPECT_LT(workspace_.rings[0].coverage, 0.5);
}

TEST_F(FindArcRingsTest, StraightLinesHaveNoArcs) {
  EXPECT_TRUE(Find([](double x, double y) {
                return x > 60 && x < 200 && y > 60 && y < 160 &&
                       !(x > 90 && x < 170 && y > 90 && y < 130);
              }).empty());
}

TEST_F(FindArcRingsTest, IgnoresImageBorder) {
  // Cut off at the top and on the left. A direct fit to a quarter of an arc is known to be too
  // small.
  const auto& rings = Find([](double x, double y) {
    return std::hypot(x - 40, y - 30) < 60 && OnRing(x + 110, y + 80);
  });
  ASSERT_FALSE(rings.empty());
  for (const ArcRing& ring : rings) {
    const double radius_px = ring.edge == RingEdge::kOuter ? 60 : 48;
    EXPECT_NEAR(std::tan(ring.cone.HalfAngles().x()) * 220, radius_px, 0.2 * radius_px);
  }
}

TEST_F(FindArcRingsTest, FindsInnerEdgeWithTouchingArms) {
  const auto& rings = Find([](double x, double y) {
    return OnRing(x, y) ||
           (std::hypot(x - 150, y - 110) < 50 && (std::abs(x - 150) < 6 || std::abs(y - 110) < 6));
  });
  const auto inner = std::find_if(rings.begin(), rings.end(), [](const ArcRing& ring) {
    return ring.edge == RingEdge::kInner;
  });
  ASSERT_NE(inner, rings.end());
  ExpectCircle(*inner);
}

TEST_F(FindArcRingsTest, UsesRequestedBordersOnly) {
  const BorderTracer tracer = TraceFigure(OnRing, 320, 240);
  ASSERT_EQ(tracer.borders().size(), 2u) << "outer and inner";
  workspace_.Reserve(tracer.capacity());
  for (std::size_t i = 0; i < 2; ++i) {
    const std::span one = std::span(tracer.borders()).subspan(i, 1);
    FindArcRings(tracer, one, rays_, {}, 0.003, 0.25, &workspace_);
    ASSERT_EQ(workspace_.rings.size(), 1u);
    ExpectCircle(workspace_.rings[0]);
  }
  FindArcRings(tracer, {}, rays_, {}, 0.003, 0.25, &workspace_);
  EXPECT_TRUE(workspace_.rings.empty());
}

}  // namespace
}  // namespace kestrel
