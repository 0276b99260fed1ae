// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/geometry/ellipse.h"

#include <algorithm>

namespace kestrel {

Ellipse EllipseFromMoments(const RegionMoments& moments) {
  // The covariance of a filled ellipse is diag(a^2, b^2) / 4 in its axes.
  const double xx = moments.covariance(0, 0);
  const double yy = moments.covariance(1, 1);
  const double xy = moments.covariance(0, 1);
  const double mean = 0.5 * (xx + yy);
  const double spread = std::hypot(0.5 * (xx - yy), xy);
  Ellipse ellipse;
  ellipse.center = moments.centroid;
  ellipse.semi_major = 2 * std::sqrt(std::max(0.0, mean + spread));
  ellipse.semi_minor = 2 * std::sqrt(std::max(0.0, mean - spread));
  ellipse.angle = 0.5 * std::atan2(2 * xy, xx - yy);
  return ellipse;
}

}  // namespace kestrel
