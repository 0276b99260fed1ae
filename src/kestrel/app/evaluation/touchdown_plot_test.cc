// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/touchdown_plot.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

using Eigen::Vector2d;

TEST(TouchdownPlotTest, ShowsPathsFromAboveAndFromSide) {
  TouchdownResult result;
  TouchdownMoment start;
  start.feet_in_world = {0, 0, 10};
  start.pattern_in_world = {6, 0, 2};
  TouchdownMoment end = start;
  end.feet_in_world = {3, 4, 2};
  end.pattern_in_world = {3, 4, 2};
  end.target_in_world = Eigen::Vector3d(3, 4.1, 2);
  result.path = {start, end};
  const Plot plot = TouchdownPlot(result);
  ASSERT_EQ(plot.panels.size(), 2);
  const PlotPanel& above = plot.panels[0];
  EXPECT_TRUE(above.equal_axes);
  EXPECT_EQ(above.series[0].points, (Points2d{{6, 0}, {3, 4}})) << "vehicle";
  EXPECT_EQ(above.series[1].points, (Points2d{{0, 0}, {3, 4}})) << "UAV";
  EXPECT_FALSE(above.series[2].points[0].allFinite()) << "no track yet";
  EXPECT_EQ(above.series[2].points[1], Vector2d(3, 4.1));
  const PlotPanel& side = plot.panels[1];
  EXPECT_LT((side.series[1].points[1] - Vector2d(5, 2)).norm(), 1e-12) << "5 m along its way";
  EXPECT_LT((side.series[0].points[0] - Vector2d(3.6, 2)).norm(), 1e-12);
}

TEST(TouchdownPlotTest, AcceptsFlightWithoutImages) {
  EXPECT_TRUE(TouchdownPlot({}).panels[0].series[1].points.empty());
}

}  // namespace
}  // namespace kestrel
