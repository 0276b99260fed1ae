// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/lens_plots.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

// Two views with one edge each, at 0 and 45 degrees from the axis of a pinhole camera.
LensCalibration TwoViews() {
  LensCalibration calibration;
  calibration.intrinsics = {640, 480, 200, 200, 320, 240, DistortionModel::kNone, {}};
  calibration.views = {{"a", {{{0, 0}, {320, 240}, {1, 0}}}, {}},
                       {"b", {{{0, 0}, {520, 240}, {1, 0}}}, {}}};
  calibration.fit.residuals_px = {{0.1}, {-0.2}};
  calibration.coverage.max_angle_deg = 45;
  return calibration;
}

TEST(LensPlotsTest, ResidualsLieAtAnglesOfTheirEdges) {
  const Plot plot = LensResidualPlot(TwoViews());
  const Points2d& points = plot.panels[0].series[0].points;
  ASSERT_EQ(points.size(), 2u);
  EXPECT_TRUE(points[0].isApprox(Eigen::Vector2d(0, 0.1)));
  EXPECT_TRUE(points[1].isApprox(Eigen::Vector2d(45, -0.2)));
}

TEST(LensPlotsTest, CurveIsDashedBeyondEdges) {
  const PlotPanel curve = LensResidualPlot(TwoViews()).panels[1];
  const PlotSeries& by_edges = curve.series[0];
  const PlotSeries& beyond = curve.series[1];
  EXPECT_NEAR(by_edges.points.back().x(), 45, 1e-9);
  EXPECT_NEAR(by_edges.points.back().y(), 200, 1e-9);
  EXPECT_EQ(beyond.style, PlotStyle::kDashes);
  // The curve goes to the corners, at 63 degrees.
  EXPECT_NEAR(beyond.points.back().x(), 63, 1);
}

TEST(LensPlotsTest, CoverageShowsAllEdgesInImage) {
  const PlotPanel panel = LensCoveragePlot(TwoViews()).panels[0];
  EXPECT_EQ(panel.series[1].points, Points2d{Eigen::Vector2d(320, 240)});
  EXPECT_EQ(panel.series[2].points, Points2d{Eigen::Vector2d(520, 240)});
  EXPECT_GT(panel.y_range.low, panel.y_range.high);  // v points down
}

}  // namespace
}  // namespace kestrel
