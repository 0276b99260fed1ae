// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/touchdown_plot.h"

#include <cmath>
#include <limits>

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// The paths, projected by 'view'.
template <class View>
std::vector<PlotSeries> Series(const std::vector<TouchdownMoment>& path, const View& view) {
  PlotSeries vehicle{"pattern", PlotStyle::kLine, {}, {}};
  PlotSeries uav{"UAV", PlotStyle::kLine, {}, {}};
  PlotSeries track{"track", PlotStyle::kLine, {}, {}};
  PlotSeries ends{"start, end", PlotStyle::kCircles, {}, {}};
  for (const TouchdownMoment& moment : path) {
    vehicle.points.push_back(view(moment.pattern_in_world));
    uav.points.push_back(view(moment.feet_in_world));
    track.points.push_back(moment.target_in_world ? view(*moment.target_in_world)
                                                  : Vector2d(std::nan(""), std::nan("")));
  }
  if (!path.empty()) ends.points = {uav.points.front(), uav.points.back()};
  return {vehicle, uav, track, ends};
}

}  // namespace

Plot TouchdownPlot(const TouchdownResult& result) {
  Vector2d along(1, 0);
  if (!result.path.empty()) {
    const Vector3d way = result.path.back().feet_in_world - result.path.front().feet_in_world;
    if (way.head<2>().norm() > 0) along = way.head<2>().normalized();
  }
  PlotPanel above{"x (east), m", "y (north), m", {}, /*equal_axes=*/true};
  above.series = Series(result.path, [](const Vector3d& p) { return Vector2d(p.head<2>()); });
  PlotPanel side{"from the start towards the touchdown, m", "height, m", {}};
  side.series = Series(result.path, [&](const Vector3d& p) {
    return Vector2d(along.dot(p.head<2>() - result.path.front().feet_in_world.head<2>()), p.z());
  });
  return {"touchdown", "Paths, seen from above and from the side", {above, side}};
}

}  // namespace kestrel
