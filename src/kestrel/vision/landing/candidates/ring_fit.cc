// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/candidates/ring_fit.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

constexpr double kMinShare = 0.95;
// For dirt or a shadow that touches a ring: the share of the border that is kept, the number of
// places at which the rest is left out, and the smaller share of points that must lie on the cone.
constexpr double kKeptShare = 0.75;
constexpr int kPlaces = 8;
constexpr double kMinShareWithDirt = 0.7;

// Uses angles, which are eq. (2) for rays. A pixel of error then counts the same on the near and on
// the far side of a ring seen obliquely from close by; in the plane of the ring it would not.
double ShareOnCone(std::span<const Eigen::Vector3d> rays, const Cone& cone, double tolerance) {
  const auto inside = std::count_if(rays.begin(), rays.end(), [&](const Eigen::Vector3d& ray) {
    return cone.AngleTo(ray) <= tolerance;
  });
  return static_cast<double>(inside) / static_cast<double>(rays.size());
}

// Sum of the squared angles between rays and cone, in tolerances, each at most 1.
double BoundedSquares(std::span<const Eigen::Vector3d> rays, const Cone& cone, double tolerance) {
  double sum = 0;
  for (const Eigen::Vector3d& ray : rays) {
    const double angle = cone.AngleTo(ray) / tolerance;
    sum += std::min(angle * angle, 1.0);
  }
  return sum;
}

// Returns the best cone (MSAC: Torr and Zisserman 2000) with a part of the border left out of the
// fit; nothing when too few points lie on it.
std::optional<Cone> FitConeBesideDirt(std::span<Eigen::Vector3d> border, double tolerance) {
  const auto kept = static_cast<std::size_t>(kKeptShare * static_cast<double>(border.size()));
  const auto step = static_cast<std::ptrdiff_t>(border.size() / kPlaces);
  std::optional<Cone> best;
  double least = static_cast<double>(border.size());
  for (int place = 0; place < kPlaces; ++place) {
    std::rotate(border.begin(), border.begin() + step, border.end());
    const std::optional<Cone> cone = FitCone(border.first(kept));
    const double squares = cone ? BoundedSquares(border, *cone, tolerance) : least;
    if (squares >= least) continue;
    best = cone;
    least = squares;
  }
  if (best && ShareOnCone(border, *best, tolerance) < kMinShareWithDirt) best.reset();
  return best;
}

}  // namespace

std::optional<RingFit> FitRing(std::span<Eigen::Vector3d> border, double radius_m,
                               double tolerance_rad) {
  std::optional<Cone> cone = FitCone(border);
  if (!cone) return std::nullopt;
  if (ShareOnCone(border, *cone, tolerance_rad) < kMinShare) {
    cone = FitConeBesideDirt(border, tolerance_rad);
    if (!cone) return std::nullopt;
  }
  Eigen::Vector3d toward = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& ray : border) toward += ray;
  return RingFit{*cone, CirclePosesFromCone(*cone, radius_m, toward)};
}

}  // namespace kestrel
