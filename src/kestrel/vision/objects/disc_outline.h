// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/ray_table.h"
#include "kestrel/core/geometry/cone.h"
#include "kestrel/core/geometry/ellipse.h"

namespace kestrel {

// The outline of a disc in the image, fitted to its edge.
struct DiscOutline {
  Cone cone;
  double residual_px = 0;  // root of the mean square distance of the edge points that fit
  double outside = 0;      // share of the outline that the image does not show
  // Longest part of the outline, as a share of it, where the image shows it and nothing fits: is
  // hidden by something.
  double gap = 0;
  double fit_share = 0;  // of the other directions, those whose edge point fits
};

// Memory of the fits.
struct DiscOutlineWorkspace {
  std::vector<Eigen::Vector2d> points;  // of the last outline, those that fit
  std::vector<int> directions;
  std::vector<Eigen::Vector3d> rays;
  std::vector<double> distances;
  std::vector<double> sorted;
};

// Fits a cone to the sub-pixel colour edge around 'start' (an ellipse that is right to 2 px).
// Edge points that lie far from the others (an occlusion, a shadow) are left out. 'focal_px' scales
// angles to pixels. Nothing when fewer than six directions show an edge or they are on no ellipse.
std::optional<DiscOutline> FitDiscOutline(const cv::Mat& image, const RayTable& rays,
                                          double focal_px, const Ellipse& start,
                                          DiscOutlineWorkspace* workspace);

// The ellipse nearest to the points (px); nothing when they do not determine one.
std::optional<Ellipse> EllipseThrough(std::span<const Eigen::Vector2d> points);

}  // namespace kestrel
