// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/plane_warp.h"

namespace kestrel {

PlaneWarp::Terms PlaneWarp::TermsAt(const Eigen::Vector2d& point) const {
  const double x = point.x() / radius_m_, y = point.y() / radius_m_;
  Terms terms;
  const double rr = x * x + y * y;
  terms << 1, x, y, x * x, x * y, y * y, rr * x, rr * y;
  return terms;
}

int PlaneWarp::DegreeOf(int term) { return term == 0 ? 0 : term < 3 ? 1 : term < 6 ? 2 : 3; }

bool PlaneWarp::Project(const Eigen::Vector2d& point, Eigen::Vector2d* pixel,
                        Eigen::Matrix2d* d_pixel_d_point) const {
  Eigen::Matrix<double, 2, 3> d_pixel;
  if (camera_.Project(plane_ * point + pose_.translation, pixel,
                      d_pixel_d_point ? &d_pixel : nullptr) == ProjectionStatus::kOutsideModel) {
    return false;
  }
  *pixel += displacement_ * TermsAt(point);
  if (!d_pixel_d_point) return true;
  const double x = point.x() / radius_m_, y = point.y() / radius_m_;
  Eigen::Matrix<double, kTerms, 2> slopes;
  slopes << 0, 0, 1, 0, 0, 1, 2 * x, 0, y, x, 0, 2 * y, 3 * x * x + y * y, 2 * x * y, 2 * x * y,
      x * x + 3 * y * y;
  *d_pixel_d_point = d_pixel * plane_ + displacement_ * slopes / radius_m_;
  return true;
}

}  // namespace kestrel
