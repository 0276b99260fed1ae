// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/border_moments.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

// Moments of the unit squares of pixels.
RegionMoments SumOfPixels(const std::vector<Eigen::Vector2d>& pixels) {
  RegionMoments moments;
  moments.area = static_cast<double>(pixels.size());
  for (const Eigen::Vector2d& p : pixels) moments.centroid += p / moments.area;
  for (const Eigen::Vector2d& p : pixels) {
    const Eigen::Vector2d d = p - moments.centroid;
    moments.covariance += d * d.transpose() / moments.area;
  }
  moments.covariance += Eigen::Matrix2d::Identity() / 12;
  return moments;
}

void ExpectSame(const RegionMoments& actual, const RegionMoments& expected) {
  EXPECT_EQ(actual.area, expected.area);
  EXPECT_LT((actual.centroid - expected.centroid).norm(), 1e-9);
  EXPECT_LT((actual.covariance - expected.covariance).norm(), 1e-6);
}

// Rows that each overlap the one before: an area without holes.
std::vector<Eigen::Vector2d> RandomArea(Random* random) {
  std::vector<Eigen::Vector2d> pixels;
  int left = random->Integer(20, 100), right = random->Integer(100, 180);
  const int top = random->Integer(4, 20), bottom = random->Integer(21, 90);
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x <= right; ++x) pixels.emplace_back(x, y);
    const int last_left = left;
    left = std::clamp(left + random->Integer(-9, 9), 4, right);
    right = std::clamp(right + random->Integer(-9, 9), std::max(left, last_left), 190);
  }
  return pixels;
}

TEST(ComputeBorderMoments, AgreesWithSumOfPixels) {
  Random random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const auto pixels = RandomArea(&random);
    // First as an area, then as a hole in a dark image.
    for (const bool hole : {false, true}) {
      BinaryImage binary;
      binary.dark.Reset(200, 100);
      binary.bright.Reset(200, 100);
      for (int y = 0; y < 100; ++y) {
        for (int x = 0; x < 200; ++x) {
          binary.bright.Set(x, y);
          if (hole && x >= 2 && y >= 2) binary.dark.Set(x, y);
        }
      }
      for (const Eigen::Vector2d& p : pixels) {
        const int x = static_cast<int>(p.x()), y = static_cast<int>(p.y());
        if (hole) {
          binary.dark.row(y)[x / 64] &= ~(std::uint64_t{1} << (x % 64));
        } else {
          binary.dark.Set(x, y);
        }
      }
      BorderTracer tracer;
      tracer.Trace(binary, cv::Rect(0, 0, 200, 100), {0, 0, 1 << 14});
      ASSERT_EQ(tracer.borders().size(), hole ? 2u : 1u);
      const Border& border = tracer.borders().back();
      ExpectSame(ComputeBorderMoments(tracer.begin(border), border.count), SumOfPixels(pixels));
    }
  }
}

TEST(ComputeBorderMoments, IsExactFarFromOrigin) {
  // A rectangle of 3000 x 2000 pixels at (16000, 12000).
  std::vector<GridPoint> points;
  const auto walk = [&](int x, int y, int dx, int dy, int count) {
    for (int i = 0; i < count; ++i) {
      points.push_back(
          {static_cast<std::int16_t>(x + i * dx), static_cast<std::int16_t>(y + i * dy)});
    }
  };
  walk(16000, 12000, 1, 0, 3000);
  walk(19000, 12000, 0, 1, 2000);
  walk(19000, 14000, -1, 0, 3000);
  walk(16000, 14000, 0, -1, 2000);
  const RegionMoments moments = ComputeBorderMoments(points.data(), points.size());
  EXPECT_EQ(moments.area, 6e6);
  EXPECT_NEAR(moments.centroid.x(), 17499.5, 1e-6);
  EXPECT_NEAR(moments.centroid.y(), 12999.5, 1e-6);
  EXPECT_NEAR(moments.covariance(0, 0), 3000.0 * 3000 / 12, 1e-6);
  EXPECT_NEAR(moments.covariance(1, 1), 2000.0 * 2000 / 12, 1e-6);
  EXPECT_NEAR(moments.covariance(0, 1), 0, 1e-6);
}

TEST(ComputeBorderMoments, IsZeroForEmptyWalk) {
  const std::vector<GridPoint> points{{3, 3}, {4, 3}};  // there and back
  EXPECT_EQ(ComputeBorderMoments(points.data(), points.size()).area, 0);
}

// A walk around the corners of a polygon with axis-parallel sides, in unit steps.
std::vector<GridPoint> WalkAround(const std::vector<GridPoint>& corners) {
  std::vector<GridPoint> points;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    GridPoint at = corners[i];
    const GridPoint to = corners[(i + 1) % corners.size()];
    while (at.x != to.x || at.y != to.y) {
      points.push_back(at);
      at.x = static_cast<std::int16_t>(at.x + (to.x > at.x) - (to.x < at.x));
      at.y = static_cast<std::int16_t>(at.y + (to.y > at.y) - (to.y < at.y));
    }
  }
  return points;
}

TEST(ComputeHullMoments, EqualsBorderMomentsOfConvexBorder) {
  const auto points = WalkAround({{100, 50}, {140, 50}, {140, 75}, {100, 75}});
  const RegionMoments border = ComputeBorderMoments(points.data(), points.size());
  const RegionMoments hull = ComputeHullMoments(ConvexHull(points));
  EXPECT_NEAR(hull.area, border.area, 1e-9);
  EXPECT_LT((hull.centroid - border.centroid).norm(), 1e-9);
  EXPECT_LT((hull.covariance - border.covariance).norm(), 1e-9);
}

TEST(ComputeHullMoments, FillNotches) {
  // A square of 30 pixels with a gap that leads into it from the right, and what it encloses.
  const auto open =
      WalkAround({{10, 10}, {40, 10}, {40, 24}, {15, 24}, {15, 27}, {40, 27}, {40, 40}, {10, 40}});
  const RegionMoments hull = ComputeHullMoments(ConvexHull(open));
  EXPECT_NEAR(hull.area, 900, 1e-9);
  EXPECT_LT((hull.centroid - Eigen::Vector2d(24.5, 24.5)).norm(), 1e-9);
  EXPECT_NEAR(hull.covariance(0, 0), 900.0 / 12, 1e-9);
  EXPECT_NEAR(hull.covariance(1, 1), 900.0 / 12, 1e-9);
  EXPECT_NEAR(hull.covariance(0, 1), 0, 1e-9);
}

TEST(ComputeHullMoments, IsZeroForLine) {
  const std::vector<GridPoint> points{{3, 3}, {4, 3}};
  EXPECT_EQ(ComputeHullMoments(ConvexHull(points)).area, 0);
}

}  // namespace
}  // namespace kestrel
