// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/ring_fit.h"

#include <cmath>

namespace kestrel {
namespace {

constexpr double kMinShare = 0.95;

// Share of the rays within 'tolerance' (rad) of the cone, to first order (Sampson's distance). This
// is the distance of eq. (2) from the ellipse of eq. (1), for rays: an error of a pixel counts the
// same on the near and on the far side of a ring that is seen obliquely from close by, which it
// does not in the plane of the ring.
double ShareOnCone(std::span<const Eigen::Vector3d> rays, const Cone& cone, double tolerance) {
  std::size_t inside = 0;
  for (const Eigen::Vector3d& ray : rays) {
    const Eigen::Vector3d gradient = 2 * cone.matrix * ray;
    const double value = 0.5 * ray.dot(gradient);
    const double slope = (gradient - gradient.dot(ray) * ray).norm();
    inside += std::abs(value) <= tolerance * slope;
  }
  return static_cast<double>(inside) / static_cast<double>(rays.size());
}

}  // namespace

std::optional<RingFit> FitRing(std::span<const Eigen::Vector3d> rays, double radius_m,
                               double tolerance_rad) {
  const std::optional<Cone> cone = FitCone(rays);
  if (!cone || ShareOnCone(rays, *cone, tolerance_rad) < kMinShare) return std::nullopt;
  Eigen::Vector3d toward = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& ray : rays) toward += ray;
  return RingFit{*cone, CirclePosesFromCone(*cone, radius_m, toward)};
}

}  // namespace kestrel
