// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/shapes/cuboid_silhouette.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>

namespace kestrel {
namespace {

constexpr int kExtents = 32;
constexpr int kResiduals = kExtents + 3;  // also the digit's position and the size
using Residuals = Eigen::Matrix<double, kResiduals, 1>;
using Parameters = Eigen::Vector4d;  // centre, yaw, logarithm of half a side
using Corners = std::array<Eigen::Vector2d, 4>;
using SideFaces = std::array<bool, 4>;  // seen at the edge from each corner to the next

const std::array<Eigen::Vector2d, kExtents>& Directions() {
  static const std::array<Eigen::Vector2d, kExtents> directions = [] {
    std::array<Eigen::Vector2d, kExtents> all;
    for (int i = 0; i < kExtents; ++i) {
      const double angle = 2 * std::numbers::pi * i / kExtents;
      all[i] = {std::cos(angle), std::sin(angle)};
    }
    return all;
  }();
  return directions;
}

Corners CornersOf(const Parameters& p) {
  const double half = std::exp(p[3]);
  const Eigen::Vector2d x = half * Eigen::Vector2d(std::cos(p[2]), std::sin(p[2]));
  const Eigen::Vector2d y(-x.y(), x.x());
  const Eigen::Vector2d center = p.head<2>();
  return {center + x + y, center - x + y, center - x - y, center + x - y};
}

// A side face is visible when the origin lies on the outer side of its edge.
SideFaces VisibleSides(const Corners& corners) {
  const Eigen::Vector2d center = 0.5 * (corners[0] + corners[2]);
  SideFaces visible{};
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d middle = 0.5 * (corners[i] + corners[(i + 1) % 4]);
    visible[i] = middle.dot(middle - center) < 0;
  }
  return visible;
}

// Returns the extent of the points in a direction.
double Extent(std::span<const Eigen::Vector2d> points, const Eigen::Vector2d& direction) {
  double extent = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& point : points) extent = std::max(extent, direction.dot(point));
  return extent;
}

class SilhouetteFit {
 public:
  explicit SilhouetteFit(const CuboidSilhouette& silhouette) : silhouette_(silhouette) {
    for (int i = 0; i < kExtents; ++i) {
      extents_[i] = Extent(silhouette.outline, Directions()[i]);
      is_seen_[i] = extents_[i] > Extent(silhouette.cut, Directions()[i]);
    }
  }

  int SeenDirections() const { return static_cast<int>(std::ranges::count(is_seen_, true)); }

  // Mean extent of the silhouette from the digit, over the directions in view.
  double MeanReach() const {
    double sum = 0;
    for (int i = 0; i < kExtents; ++i) {
      if (is_seen_[i]) sum += extents_[i] - Directions()[i].dot(silhouette_.digit);
    }
    return sum / SeenDirections();
  }

  // Weighted residuals: the difference in extent between silhouette and cuboid in all directions,
  // then the offsets of the digit from the middle and of the size from the expected one.
  Residuals ResidualsOf(const Parameters& p, const SideFaces& sides) const {
    constexpr double kDigitWeight = 0.3;
    constexpr double kSizeWeight = 0.6;
    const double half = std::exp(p[3]);
    const Corners corners = CornersOf(p);
    const double shrinking = 1 / (1 + 2 * half * silhouette_.height_by_side);
    Residuals residuals;
    for (int i = 0; i < kExtents; ++i) {
      double extent = -std::numeric_limits<double>::infinity();
      for (int k = 0; k < 4; ++k) {
        const double upper = Directions()[i].dot(corners[k]);
        extent = std::max(extent, upper);
        if (sides[k] || sides[(k + 3) % 4]) extent = std::max(extent, shrinking * upper);
      }
      residuals[i] = is_seen_[i] ? (extents_[i] - extent) / half : 0;
    }
    residuals.segment<2>(kExtents) = kDigitWeight / half * (p.head<2>() - silhouette_.digit);
    residuals[kResiduals - 1] =
        silhouette_.half_side ? kSizeWeight * (p[3] - std::log(*silhouette_.half_side)) : 0;
    return residuals;
  }

  // Gauss-Newton steps while they reduce the sum of squares. Returns that sum.
  double Refine(const SideFaces& sides, Parameters* p) const {
    constexpr int kMaxSteps = 8;
    constexpr double kStep = 1e-4;
    Residuals residuals = ResidualsOf(*p, sides);
    for (int step = 0; step < kMaxSteps; ++step) {
      Eigen::Matrix<double, kResiduals, 4> jacobian;
      for (int i = 0; i < 4; ++i) {
        const double size = i < 2 ? kStep * std::exp((*p)[3]) : kStep;
        jacobian.col(i) = (ResidualsOf(*p + size * Parameters::Unit(i), sides) - residuals) / size;
      }
      const Parameters change =
          (jacobian.transpose() * jacobian).ldlt().solve(jacobian.transpose() * residuals);
      const Parameters next = *p - change;
      const Residuals next_residuals = ResidualsOf(next, sides);
      if (!(next_residuals.squaredNorm() < residuals.squaredNorm())) break;
      *p = next;
      residuals = next_residuals;
    }
    return residuals.squaredNorm();
  }

 private:
  const CuboidSilhouette& silhouette_;
  std::array<double, kExtents> extents_;
  std::array<bool, kExtents> is_seen_;
};

}  // namespace

std::optional<CuboidFit> FitCuboid(const CuboidSilhouette& silhouette) {
  constexpr int kYaws = 18;
  const SilhouetteFit fit(silhouette);
  const int seen = fit.SeenDirections();
  if (seen < kExtents / 2) return std::nullopt;
  const double half = silhouette.half_side.value_or(0.7 * fit.MeanReach());
  if (!(half > 0)) return std::nullopt;
  // For each set of coloured side faces that can be visible, refines the best start direction.
  double best_sum = std::numeric_limits<double>::infinity();
  Parameters best = Parameters::Zero();
  for (int choice = 0; choice < 1 << 4; ++choice) {
    SideFaces sides{};
    for (int k = 0; k < 4; ++k) sides[k] = (choice >> k & 1) != 0;
    double start_sum = std::numeric_limits<double>::infinity();
    Parameters best_start;
    for (int i = 0; i < kYaws; ++i) {
      Parameters start;
      start << silhouette.digit, std::numbers::pi / 2 * i / kYaws, std::log(half);
      const bool can_be = std::ranges::equal(
          sides, VisibleSides(CornersOf(start)),
          [](bool is_colored, bool is_visible) { return !is_colored || is_visible; });
      const double sum = can_be ? fit.ResidualsOf(start, sides).squaredNorm() : start_sum;
      if (sum >= start_sum) continue;
      start_sum = sum;
      best_start = start;
    }
    if (!std::isfinite(start_sum)) continue;
    const double sum = fit.Refine(sides, &best_start);
    if (sum >= best_sum) continue;
    best_sum = sum;
    best = best_start;
  }
  return CuboidFit{CornersOf(best), std::sqrt(best_sum / seen)};
}

}  // namespace kestrel
