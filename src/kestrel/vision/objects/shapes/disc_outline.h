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

// The outline of a disc in the image, fitted to its colour edge.
struct DiscOutline {
  Cone cone;
  double residual_px = 0;  // root mean square distance of the edge points that fit
  double outside = 0;      // share of the outline that is out of view
  // Longest connected part of the outline, as a share of it, that is in view without an edge that
  // fits, because something hides it.
  double gap = 0;
  double fit_share = 0;  // share of the other directions whose edge point fits
};

// Memory of FitDiscOutline.
struct DiscOutlineWorkspace {
  std::vector<Eigen::Vector2d> points;  // points of the last outline that fit
  std::vector<int> directions;
  std::vector<Eigen::Vector3d> rays;
  std::vector<double> distances;
  std::vector<double> sorted;
};

// Fits a cone to the sub-pixel colour edge around 'start' (an ellipse that is right to 2 px). Edge
// points far from the others (an occlusion, a shadow) are left out. 'focal_px' converts angles to
// pixels. Returns nothing when fewer than six directions show an edge or the edges lie on no
// ellipse.
std::optional<DiscOutline> FitDiscOutline(const cv::Mat& image, const RayTable& rays,
                                          double focal_px, const Ellipse& start,
                                          DiscOutlineWorkspace* workspace);

// Returns the ellipse nearest to the points (px); nothing when they do not determine one.
std::optional<Ellipse> EllipseThrough(std::span<const Eigen::Vector2d> points);

}  // namespace kestrel
