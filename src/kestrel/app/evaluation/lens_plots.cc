// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/lens_plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/evaluation/statistics.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

constexpr double kBinDeg = 5;
constexpr int kColorCount = 5;

std::optional<double> AngleDeg(const CameraModel& camera, const Vector2d& pixel) {
  Eigen::Vector3d ray;
  if (camera.Unproject(pixel, &ray) == ProjectionStatus::kOutsideModel) return std::nullopt;
  return Degrees(std::atan2(ray.head<2>().norm(), ray.z()));
}

// Root mean squares of 'residuals' (angle, px) in bins of the angle.
Points2d ByAngle(const Points2d& residuals) {
  std::vector<std::vector<double>> bins;
  for (const Vector2d& residual : residuals) {
    const auto bin = static_cast<std::size_t>(residual.x() / kBinDeg);
    if (bins.size() <= bin) bins.resize(bin + 1);
    bins[bin].push_back(residual.y());
  }
  Points2d points;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    points.emplace_back((static_cast<double>(i) + 0.5) * kBinDeg, RootMeanSquare(bins[i]));
  }
  return points;
}

// The distance from the principal point, to its right, over the angle to the axis.
PlotPanel CurvePanel(const CameraModel& camera, double max_angle_deg) {
  PlotSeries by_edges{"lens, by the edges", PlotStyle::kLine, {}, {}};
  PlotSeries beyond{"extrapolated", PlotStyle::kDashes, {}, {}};
  const Vector2d principal(camera.intrinsics().cx_px, camera.intrinsics().cy_px);
  const Vector2d farthest(std::max(principal.x(), camera.width_px() - principal.x()),
                          std::max(principal.y(), camera.height_px() - principal.y()));
  for (double angle = 0; angle < Degrees(camera.max_angle()); ++angle) {
    const double radians = Radians(angle);
    Vector2d pixel;
    if (camera.Project({std::sin(radians), 0, std::cos(radians)}, &pixel) ==
        ProjectionStatus::kOutsideModel) {
      break;
    }
    const double radius = (pixel - principal).norm();
    if (radius > farthest.norm()) break;
    (angle <= max_angle_deg ? by_edges : beyond).points.emplace_back(angle, radius);
  }
  return {"angle from the optical axis, degrees",
          "distance from the principal point, px",
          {by_edges, beyond}};
}

}  // namespace

Plot LensResidualPlot(const LensCalibration& calibration) {
  const CameraModel camera(calibration.intrinsics);
  PlotSeries residuals{"edges", PlotStyle::kDots, {}, {}};
  for (std::size_t i = 0; i < calibration.views.size(); ++i) {
    const std::vector<LensEdge>& edges = calibration.views[i].edges;
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const std::optional<double> angle = AngleDeg(camera, edges[k].pixel);
      if (angle) residuals.points.emplace_back(*angle, calibration.fit.residuals_px[i][k]);
    }
  }
  const PlotSeries spread{"root mean square", PlotStyle::kLine, ByAngle(residuals.points), {}};
  const PlotPanel panel{"angle from the optical axis, degrees",
                        "residual across the outline, px",
                        {residuals, spread}};
  return {"lens_residuals",
          fmt::format("Lens: what it leaves unexplained, {:.3f} px root mean square",
                      calibration.fit.RootMeanSquare()),
          {panel, CurvePanel(camera, calibration.coverage.max_angle_deg)}};
}

Plot LensCoveragePlot(const LensCalibration& calibration) {
  const CameraIntrinsics& camera = calibration.intrinsics;
  const double right = camera.width_px - 0.5, bottom = camera.height_px - 0.5;
  PlotPanel panel{"u, px", "v, px", {}, /*equal_axes=*/true, {bottom + 20, -20}};
  panel.series.push_back(
      {"image",
       PlotStyle::kDashes,
       {{-0.5, -0.5}, {right, -0.5}, {right, bottom}, {-0.5, bottom}, {-0.5, -0.5}},
       {}});
  for (int color = 0; color < kColorCount; ++color) {
    panel.series.push_back({color == 0 ? "edges" : "", PlotStyle::kDots, {}, {}});
  }
  for (std::size_t i = 0; i < calibration.views.size(); ++i) {
    Points2d& points = panel.series[1 + i % kColorCount].points;
    for (const LensEdge& edge : calibration.views[i].edges) points.push_back(edge.pixel);
  }
  panel.series.push_back(
      {"principal point", PlotStyle::kCrosses, {{camera.cx_px, camera.cy_px}}, {}});
  return {"lens_coverage",
          fmt::format("Lens: edges of {} views in the image", calibration.views.size()),
          {panel}};
}

}  // namespace kestrel
