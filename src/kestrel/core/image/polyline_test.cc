// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/polyline.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

using Points = std::vector<Eigen::Vector2d>;

void AddLine(const Eigen::Vector2d& from, const Eigen::Vector2d& to, int count, Points* points) {
  for (int i = 0; i < count; ++i) points->push_back(from + (to - from) * i / count);
}

// A rectangle of 60 x 30 around the origin, turned; the walk begins in the middle of a side.
Points Rectangle(double angle) {
  Points points;
  AddLine({0, -15}, {30, -15}, 30, &points);
  AddLine({30, -15}, {30, 15}, 30, &points);
  AddLine({30, 15}, {-30, 15}, 60, &points);
  AddLine({-30, 15}, {-30, -15}, 30, &points);
  AddLine({-30, -15}, {0, -15}, 30, &points);
  for (Eigen::Vector2d& p : points) {
    p = Eigen::Vector2d(std::cos(angle) * p.x() - std::sin(angle) * p.y(),
                        std::sin(angle) * p.x() + std::cos(angle) * p.y());
  }
  return points;
}

std::vector<LineSegment> Split(const Points& points, bool closed, double tolerance,
                               double min_length) {
  std::vector<std::size_t> breaks;
  std::vector<LineSegment> segments;
  SplitAndMerge(points, closed, tolerance, min_length, &breaks, &segments);
  return segments;
}

void ExpectRectangle(const std::vector<LineSegment>& segments, double angle, double tolerance) {
  ASSERT_EQ(segments.size(), 4u);
  int along = 0;
  for (const LineSegment& segment : segments) {
    const Eigen::Vector2d axis(std::cos(angle), std::sin(angle));
    const double cosine = std::abs(segment.direction().dot(axis));
    const bool is_long = cosine > 0.5;
    along += is_long;
    EXPECT_NEAR(cosine, is_long ? 1 : 0, 0.03 * tolerance);
    // A corner may be cut within the tolerance.
    EXPECT_NEAR(segment.length(), is_long ? 60 : 30, 5 * tolerance);
    // Both ends are as far from the centre as the side.
    const Eigen::Vector2d normal(-segment.direction().y(), segment.direction().x());
    EXPECT_NEAR(std::abs(normal.dot(0.5 * (segment.start + segment.end))), is_long ? 15 : 30,
                tolerance);
  }
  EXPECT_EQ(along, 2);
}

TEST(SplitAndMerge, RectangleHasFourSides) {
  for (const double angle : {0.0, 0.3, 1.0, 2.5}) {
    ExpectRectangle(Split(Rectangle(angle), true, 0.5, 5), angle, 0.5);
  }
}

TEST(SplitAndMerge, ToleratesNoise) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const double angle = random.Uniform(0, 3);
    Points points = Rectangle(angle);
    for (Eigen::Vector2d& p : points) {
      p += Eigen::Vector2d{random.Uniform(-0.5, 0.5), random.Uniform(-0.5, 0.5)};
    }
    ExpectRectangle(Split(points, true, 1.5, 8), angle, 1.5);
  }
}

TEST(SplitAndMerge, OpenCurveKeepsItsEnds) {
  Points points;
  AddLine({0, 0}, {40, 0}, 40, &points);
  AddLine({40, 0}, {40, 20}, 20, &points);
  points.push_back({40, 20});
  const auto segments = Split(points, false, 0.5, 1);
  ASSERT_EQ(segments.size(), 2u);
  EXPECT_LT((segments[0].start - Eigen::Vector2d(0, 0)).norm(), 1e-9);
  EXPECT_LT((segments[0].end - Eigen::Vector2d(40, 0)).norm(), 1e-9);
  EXPECT_LT((segments[1].start - Eigen::Vector2d(40, 0)).norm(), 1e-9);
  EXPECT_LT((segments[1].end - Eigen::Vector2d(40, 20)).norm(), 1e-9);
}

TEST(SplitAndMerge, MergesSegmentsOnOneLine) {
  // A kink that the first split takes for a corner: the farthest point of a Z lies on its bend.
  Points points;
  AddLine({0, 0}, {50, 0.4}, 50, &points);
  AddLine({50, 0.4}, {100, 0}, 50, &points);
  EXPECT_EQ(Split(points, false, 0.5, 1).size(), 1u);
  EXPECT_EQ(Split(points, false, 0.3, 1).size(), 2u);
}

TEST(SplitAndMerge, LengthOfCirclePiecesMatchesTolerance) {
  constexpr double kRadius = 50, kTolerance = 1;
  Points points;
  for (int i = 0; i < 300; ++i) {
    const double t = 2 * std::numbers::pi * i / 300;
    points.emplace_back(kRadius * std::cos(t), kRadius * std::sin(t));
  }
  const auto segments = Split(points, true, kTolerance, 0);
  // A chord whose arc rises by the tolerance is 2 sqrt(2 r t) long: at least 16 of them.
  const double longest = 2 * std::sqrt(2 * kRadius * kTolerance);
  EXPECT_GE(segments.size(), 16u);
  EXPECT_LE(segments.size(), 40u);
  for (const LineSegment& segment : segments) EXPECT_LT(segment.length(), 1.05 * longest);
  EXPECT_TRUE(Split(points, true, kTolerance, 1.1 * longest).empty());
}

TEST(SplitAndMerge, AppendsToOutputAndHandlesMinimalInput) {
  std::vector<std::size_t> breaks{7, 8, 9};
  std::vector<LineSegment> segments;
  SplitAndMerge(Points{{0, 0}, {1, 0}}, false, 0.1, 0, &breaks, &segments);
  EXPECT_TRUE(segments.empty()) << "two points are no curve";
  const Points line{{0, 0}, {1, 0}, {2, 0}};
  SplitAndMerge(line, false, 0.1, 0, &breaks, &segments);
  SplitAndMerge(line, false, 0.1, 0, &breaks, &segments);
  EXPECT_EQ(segments.size(), 2u);
  const Points one_place(5, Eigen::Vector2d(3, 3));
  SplitAndMerge(one_place, true, 0.1, 1, &breaks, &segments);
  EXPECT_EQ(segments.size(), 2u);
}

}  // namespace
}  // namespace kestrel
