// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/candidates/dark_areas.h"

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

// Traces the borders of a figure of 100 x 100 pixels.
BorderTracer TraceSmallFigure(const Print& is_dark) {
  BinaryImage binary;
  binary.dark.Reset(100, 100);
  binary.bright.Reset(100, 100);
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) {
      binary.bright.Set(x, y);
      if (is_dark(x - 50, y - 50)) binary.dark.Set(x, y);
    }
  }
  BorderTracer tracer;
  tracer.Trace(binary, cv::Rect(0, 0, 100, 100), BorderLimits{});
  return tracer;
}

// Returns the areas that the borders of a figure are taken for.
std::vector<DarkArea> Areas(const Print& is_dark, double min_minor_px = 8,
                            int max_hull_extent = 0) {
  const BorderTracer tracer = TraceSmallFigure(is_dark);
  std::vector<DarkArea> areas;
  for (const Border& border : tracer.borders()) {
    if (const auto area = TestDarkArea(tracer, border, min_minor_px, max_hull_extent)) {
      areas.push_back(*area);
    }
  }
  return areas;
}

TEST(TestDarkArea, RingHasTwoEdges) {
  const auto areas = Areas([](double x, double y) {
    const double r = std::hypot(x / 1.5, y);
    return r > 16 && r < 20;
  });
  ASSERT_EQ(areas.size(), 2u);
  EXPECT_EQ(areas[0].edge, RingEdge::kOuter);
  EXPECT_NEAR(areas[0].outline.semi_major, 30, 0.3);
  EXPECT_NEAR(areas[0].outline.semi_minor, 20, 0.3);
  EXPECT_LT((areas[0].outline.center - Eigen::Vector2d(50, 50)).norm(), 0.05);
  EXPECT_GT(areas[0].ellipticity, 0.99);
  EXPECT_EQ(areas[1].edge, RingEdge::kInner);
  EXPECT_NEAR(areas[1].outline.semi_minor, 16, 0.3);
}

TEST(TestDarkArea, RefusesNonConvexFigures) {
  EXPECT_TRUE(Areas([](double x, double y) {  // an L
                return std::abs(x) < 30 && std::abs(y) < 30 && (x < -20 || y > 20);
              })
                  .empty());
  EXPECT_TRUE(Areas([](double x, double y) { return IsSpoke(x, y, 4, 4, 30); }).empty());
}

TEST(TestDarkArea, RefusesBarsAndSmallFigures) {
  EXPECT_TRUE(
      Areas([](double x, double y) { return std::abs(x) < 40 && std::abs(y) < 4; }).empty());
  const Print disc = [](double x, double y) { return std::hypot(x, y) < 9.5; };
  EXPECT_EQ(Areas(disc, 18).size(), 1u);
  EXPECT_TRUE(Areas(disc, 20).empty());
}

TEST(TestDarkArea, SmallOpenRingIsReplacedByHull) {
  const Print open_ring = [](double x, double y) {
    const double r = std::hypot(x, y);
    return r > 13 && r < 17 && !(x > 0 && std::abs(y) < 2.5);
  };
  EXPECT_TRUE(Areas(open_ring).empty());
  const auto areas = Areas(open_ring, 8, 40);
  ASSERT_EQ(areas.size(), 1u);
  EXPECT_EQ(areas[0].edge, RingEdge::kOuter);
  EXPECT_NEAR(areas[0].outline.semi_major, 17, 0.6);
  EXPECT_NEAR(areas[0].outline.semi_minor, 17, 0.6);
  EXPECT_TRUE(Areas(open_ring, 8, 30).empty()) << "larger than small ones";
}

TEST(OutlineInView, OmitsImageBorderFromOutline) {
  const Eigen::Vector2d center(85, 40);  // ring cut off on the right
  const BorderTracer tracer = TraceSmallFigure([&](double x, double y) {
    const double r = (Eigen::Vector2d(x, y) - center + Eigen::Vector2d(50, 50)).norm();
    return std::abs(r - 24) < 2;
  });
  ASSERT_EQ(tracer.borders().size(), 1u);
  EXPECT_TRUE(IsCutOff(tracer, tracer.borders()[0]));
  std::array<Eigen::Vector2d, 300> outline;
  const std::size_t count = OutlineInView(tracer, tracer.borders()[0], outline);
  EXPECT_GT(count, 105u) << "as long as the arc in view";
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_NEAR((outline[i] - center).norm(), 26, 0.8) << outline[i].transpose();
    EXPECT_LT(outline[i].x(), 99);
  }
  EXPECT_EQ(OutlineInView(tracer, tracer.borders()[0], std::span(outline).first(20)), 20u);
}

TEST(IsCutOff, IsFalseForAreaWithinImage) {
  const BorderTracer tracer =
      TraceSmallFigure([](double x, double y) { return std::hypot(x, y) < 48; });
  ASSERT_EQ(tracer.borders().size(), 1u);
  EXPECT_FALSE(IsCutOff(tracer, tracer.borders()[0]));
}

class ContrastTest : public ::testing::Test {
 protected:
  cv::Mat Draw(const Print& print) const {
    return DrawPrint(TestPrintCamera(), pattern_, print, PrintPose({0, 0, 2.2}, 0, 0, 0.2));
  }
  const LandingPattern pattern_{};
  const Ellipse ring_{Eigen::Vector2d(159.5, 119.5), 50, 50, 0};
};

TEST_F(ContrastTest, MeasuresRingAndWhiteBoard) {
  const cv::Mat image = Draw(SpokedPrint(pattern_, 4));
  EXPECT_GT(RingContrast(image, ring_, pattern_), 120);
  EXPECT_GT(BoardContrast(image, ring_), 120);
  Ellipse elsewhere = ring_;
  elsewhere.center.x() += 40;
  EXPECT_EQ(RingContrast(image, elsewhere, pattern_), 0);
}

TEST_F(ContrastTest, DiscHasNoRingContrast) {
  const cv::Mat disc =
      Draw([this](double x, double y) { return std::hypot(x, y) < pattern_.outer_radius_m(); });
  EXPECT_EQ(RingContrast(disc, ring_, pattern_), 0) << "there must be white inside";
}

TEST_F(ContrastTest, FlatImageHasNoContrast) {
  const cv::Mat flat(240, 320, CV_8UC1, cv::Scalar(100));
  EXPECT_EQ(RingContrast(flat, ring_, pattern_), 0);
  EXPECT_EQ(BoardContrast(flat, ring_), 0);
}

TEST_F(ContrastTest, ToleratesLossOfQuarter) {
  cv::Mat image = Draw(SpokedPrint(pattern_, 4));
  image(cv::Rect(160, 20, 100, 99)) = 240;  // a highlight
  EXPECT_GT(RingContrast(image, ring_, pattern_), 100);
  image(cv::Rect(0, 20, 320, 99)) = 240;
  EXPECT_EQ(RingContrast(image, ring_, pattern_), 0);
}

}  // namespace
}  // namespace kestrel
