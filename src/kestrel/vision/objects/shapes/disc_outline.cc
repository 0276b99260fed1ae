// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/shapes/disc_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/vision/objects/shapes/color_edge.h"

namespace kestrel {
namespace {

constexpr int kEdgeDirections = 32;  // directions in which the edge is searched

// Angle between a ray and the cone, to first order (Sampson's distance), rad; negative inside.
double DistanceToCone(const Cone& cone, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d gradient = 2 * cone.matrix * ray;
  const double slope = (gradient - gradient.dot(ray) * ray).norm();
  return ray.dot(cone.matrix * ray) / std::max(slope, std::numeric_limits<double>::min());
}

void MeasureDistances(const Cone& cone, double focal_px, DiscOutlineWorkspace* workspace) {
  workspace->distances.clear();
  for (const Eigen::Vector3d& ray : workspace->rays) {
    workspace->distances.push_back(focal_px * DistanceToCone(cone, ray));
  }
}

double MedianDistance(DiscOutlineWorkspace* workspace) {
  auto& sorted = workspace->sorted;
  sorted.clear();
  for (const double distance : workspace->distances) sorted.push_back(std::abs(distance));
  return MedianInPlace(sorted);
}

// Removes the rays farther than the limit from the cone. True when there were any. An object that
// hides a part of a disc makes an edge inside of its outline, which also draws the fit inwards; the
// limit is therefore larger outside.
bool DropOutliers(double limit_px, DiscOutlineWorkspace* workspace) {
  auto& rays = workspace->rays;
  auto& points = workspace->points;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double distance = workspace->distances[i];
    if (distance < -limit_px || distance > 3 * limit_px) continue;
    rays[kept] = rays[i];
    workspace->directions[kept] = workspace->directions[i];
    points[kept++] = points[i];
  }
  const bool dropped = kept < rays.size();
  rays.resize(kept);
  points.resize(kept);
  workspace->directions.resize(kept);
  return dropped;
}

// Blur of standard deviation s moves the half-way point of the light of a disc of radius r inwards
// by s^2 / (2 r), because more of the surroundings than of the disc lies around a point of its
// edge.
double CurvatureShift(double blur_px, double radius_px) {
  constexpr double kMaxBlurPx = 2;
  const double blur = std::min(blur_px, kMaxBlurPx);
  return blur * blur / (2 * radius_px);
}

// Returns the ellipse in which a cone meets the plane z = 1.
std::optional<Ellipse> CutWithPlane(const Eigen::Matrix3d& conic) {
  const Eigen::Matrix2d a = conic.topLeftCorner<2, 2>();
  if (!(a.determinant() > 0)) return std::nullopt;
  const Eigen::Matrix2d inverse = a.inverse();
  const Eigen::Vector2d b = conic.topRightCorner<2, 1>();
  RegionMoments moments;
  moments.centroid = -inverse * b;
  const double scale = b.dot(inverse * b) - conic(2, 2);
  if (!(scale > 0)) return std::nullopt;
  moments.covariance = scale / 4 * inverse;
  return EllipseFromMoments(moments);
}

// Result of the edge search in one direction.
enum class Direction { kHidden, kOutside, kFits };
using EdgeDirections = std::array<Direction, kEdgeDirections>;

// Returns the length of the longest run of hidden directions around the circle.
int LargestGap(const EdgeDirections& directions) {
  int largest = 0;
  int run = 0;
  for (int i = 0; i < 2 * kEdgeDirections && largest < kEdgeDirections; ++i) {
    run = directions[i % kEdgeDirections] == Direction::kHidden ? run + 1 : 0;
    largest = std::max(largest, run);
  }
  return largest;
}

std::optional<DiscOutline> FitOnce(const cv::Mat& image, const RayTable& rays, double focal_px,
                                   const Ellipse& start, DiscOutlineWorkspace* workspace) {
  constexpr int kMaxRounds = 6;
  constexpr double kMinLimitPx = 0.5;
  constexpr double kMinLimitShare = 0.015;  // share of the radius; no disc is cut perfectly
  const double radius_px = std::sqrt(start.semi_major * start.semi_minor);
  workspace->rays.clear();
  workspace->points.clear();
  workspace->directions.clear();
  EdgeDirections directions{};
  for (int i = 0; i < kEdgeDirections; ++i) {
    const double t = 2 * std::numbers::pi * i / kEdgeDirections;
    const Eigen::Vector2d outward = (start.semi_minor * std::cos(t) * start.major_axis() +
                                     start.semi_major * std::sin(t) * start.minor_axis())
                                        .normalized();
    const Eigen::Vector2d point = start.At(t);
    if (!ShowsColorEdge(image.size(), point, outward)) directions[i] = Direction::kOutside;
    const std::optional<ColorEdge> edge = FindColorEdge(image, point, outward);
    if (!edge) continue;
    const double offset_px = edge->offset_px + CurvatureShift(edge->blur_px, radius_px);
    const Eigen::Vector2d at = point + offset_px * outward;
    const Eigen::Vector3d ray =
        rays.Ray(static_cast<float>(at.x()), static_cast<float>(at.y())).cast<double>();
    if (!(ray.squaredNorm() > 0)) continue;
    workspace->rays.push_back(ray);
    workspace->points.push_back(at);
    workspace->directions.push_back(i);
  }
  std::optional<Cone> cone = FitCone(workspace->rays);
  for (int round = 0; cone && round < kMaxRounds; ++round) {
    MeasureDistances(*cone, focal_px, workspace);
    const double limit_px =
        std::max({kMinLimitPx, kMinLimitShare * radius_px, 2.5 * MedianDistance(workspace)});
    if (!DropOutliers(limit_px, workspace)) break;
    cone = FitCone(workspace->rays);
  }
  if (!cone) return std::nullopt;
  MeasureDistances(*cone, focal_px, workspace);
  double squares = 0;
  for (const double distance : workspace->distances) squares += distance * distance;
  for (const int direction : workspace->directions) directions[direction] = Direction::kFits;
  const auto count = static_cast<double>(workspace->rays.size());
  const double gap = LargestGap(directions);
  const auto outside = static_cast<double>(std::ranges::count(directions, Direction::kOutside));
  return DiscOutline{*cone, std::sqrt(squares / count), outside / kEdgeDirections,
                     gap / kEdgeDirections, count / std::max(1.0, kEdgeDirections - outside - gap)};
}

}  // namespace

std::optional<DiscOutline> FitDiscOutline(const cv::Mat& image, const RayTable& rays,
                                          double focal_px, const Ellipse& start,
                                          DiscOutlineWorkspace* workspace) {
  std::optional<DiscOutline> outline = FitOnce(image, rays, focal_px, start, workspace);
  // For a disc not entirely in view the start was inaccurate: fits again from the result.
  if (!outline || outline->gap + outline->outside == 0) return outline;
  const std::optional<Ellipse> better = EllipseThrough(workspace->points);
  if (!better) return outline;
  const std::optional<DiscOutline> again = FitOnce(image, rays, focal_px, *better, workspace);
  return again ? again : outline;
}

std::optional<Ellipse> EllipseThrough(std::span<const Eigen::Vector2d> points) {
  // A plane of pixels as if seen by a camera, because FitCone works on rays.
  constexpr std::size_t kMaxPoints = 512;
  if (points.empty()) return std::nullopt;
  Eigen::Vector2d min = points.front();
  Eigen::Vector2d max = points.front();
  for (const Eigen::Vector2d& point : points) {
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  const Eigen::Vector2d middle = 0.5 * (min + max);
  const double scale = std::max(1.0, (max - min).maxCoeff());
  std::array<Eigen::Vector3d, kMaxPoints> rays;
  std::size_t count = 0;
  const std::size_t step = (points.size() + kMaxPoints - 1) / kMaxPoints;
  for (std::size_t i = 0; i < points.size(); i += step) {
    const Eigen::Vector2d x = (points[i] - middle) / scale;
    rays[count++] = Eigen::Vector3d(x.x(), x.y(), 1).normalized();
  }
  const std::optional<Cone> cone = FitCone(std::span(rays).first(count));
  if (!cone) return std::nullopt;
  std::optional<Ellipse> ellipse = CutWithPlane(cone->matrix);
  if (!ellipse) return std::nullopt;
  ellipse->center = middle + scale * ellipse->center;
  ellipse->Scale(scale);
  return ellipse;
}

}  // namespace kestrel
