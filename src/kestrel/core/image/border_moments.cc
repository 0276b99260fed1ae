// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/border_moments.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace kestrel {
namespace {

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

RegionMoments ComputeBorderMoments(const GridPoint* points, std::size_t count) {
  // Steps are axis-parallel and of length one, so only those along y contribute. The sums are
  // integers, relative to the first point.
  std::int64_t area = 0;
  std::int64_t x1 = 0, y1 = 0;             // twice the first moments
  std::int64_t xx3 = 0, xy4 = 0, yy3 = 0;  // 3, 4 and 3 times the second moments
  const std::int64_t origin_x = points[0].x;
  const std::int64_t origin_y = points[0].y;
  for (std::size_t i = 0; i < count; ++i) {
    const GridPoint& a = points[i];
    const GridPoint& b = points[i + 1 < count ? i + 1 : 0];
    const std::int64_t dy = b.y - a.y;
    if (dy == 0) continue;
    const std::int64_t x = a.x - origin_x;
    const std::int64_t y = a.y - origin_y;
    const std::int64_t y_sum = 2 * y + dy;  // y at both ends
    // Integrals over the strip from x = 0 to x.
    area += x * dy;
    x1 += x * x * dy;
    y1 += x * y_sum * dy;
    xx3 += x * x * x * dy;
    xy4 += x * x * y_sum * dy;
    yy3 += x * (3 * y * y + 3 * y * dy + 1) * dy;
  }
  const double sign = area < 0 ? -1.0 : 1.0;
  RegionMoments moments;
  moments.area = sign * static_cast<double>(area);
  if (area == 0) return moments;
  const auto mean = [&](std::int64_t sum, double factor) {
    return sign * static_cast<double>(sum) / (factor * moments.area);
  };
  const Eigen::Vector2d centroid(mean(x1, 2), mean(y1, 2));
  moments.covariance(0, 0) = mean(xx3, 3) - centroid.x() * centroid.x();
  moments.covariance(1, 1) = mean(yy3, 3) - centroid.y() * centroid.y();
  moments.covariance(0, 1) = moments.covariance(1, 0) = mean(xy4, 4) - centroid.x() * centroid.y();
  moments.centroid = centroid + Eigen::Vector2d(static_cast<double>(origin_x) - 0.5,
                                                static_cast<double>(origin_y) - 0.5);
  return moments;
}

RegionMoments ComputeHullMoments(const ConvexHull& hull) {
  const std::span<const Eigen::Vector2d> corners = hull.corners();
  // Relative to a corner, so that large coordinates lose no precision.
  const Eigen::Vector2d& origin = corners.front();
  double twice_area = 0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();  // moments
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d a = corners[i] - origin;
    const Eigen::Vector2d b = corners[(i + 1) % corners.size()] - origin;
    const double cross = Cross(a, b);  // twice the triangle of the two and the origin
    const Eigen::Vector2d sum = a + b;
    twice_area += cross;
    first += cross / 6 * sum;
    second += cross / 24 * (a * a.transpose() + b * b.transpose() + sum * sum.transpose());
  }
  RegionMoments moments;
  moments.area = 0.5 * twice_area;
  if (moments.area <= 0) return moments;
  const Eigen::Vector2d centroid = first / moments.area;
  moments.covariance = second / moments.area - centroid * centroid.transpose();
  moments.centroid = centroid + origin;
  return moments;
}

}  // namespace kestrel
