// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/plane_warp.h"

#include <algorithm>

namespace kestrel {
namespace {

// Of points that are projected at once.
constexpr std::size_t kProjectedAtOnce = 64;
using Values = std::array<float, kProjectedAtOnce>;
using Axis = std::array<float, PlaneWarp::kTerms>;

// Adds the slopes of one axis' displacement to its derivatives.
void AddSlopes(const Axis& c, float per_m, const float* x_m, const float* y_m, std::size_t count,
               float* by_x, float* by_y) {
  for (std::size_t i = 0; i < count; ++i) {
    const float x = per_m * x_m[i], y = per_m * y_m[i];
    by_x[i] +=
        per_m * (c[1] + 2 * c[3] * x + c[4] * y + c[6] * (3 * x * x + y * y) + 2 * c[7] * x * y);
    by_y[i] +=
        per_m * (c[2] + c[4] * x + 2 * c[5] * y + 2 * c[6] * x * y + c[7] * (x * x + 3 * y * y));
  }
}

}  // namespace

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

void PlaneWarp::ProjectMany(const float* x_m, const float* y_m, std::size_t count, float* x_px,
                            float* y_px, const std::array<float*, 4>* d_pixel_d_point) const {
  const Eigen::Matrix<float, 3, 2> plane = plane_.cast<float>();
  const Eigen::Vector3f center = pose_.translation.cast<float>();
  const auto per_m = static_cast<float>(1 / radius_m_);
  for (std::size_t first = 0; first < count; first += kProjectedAtOnce) {
    const std::size_t n = std::min(kProjectedAtOnce, count - first);
    const float* x = x_m + first;
    const float* y = y_m + first;
    std::array<Values, 3> points;
    for (int k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < n; ++i) {
        points[k][i] = center(k) + plane(k, 0) * x[i] + plane(k, 1) * y[i];
      }
    }
    std::array<Values, 6> by_point;
    const std::array<float*, 6> outputs{by_point[0].data(), by_point[1].data(), by_point[2].data(),
                                        by_point[3].data(), by_point[4].data(), by_point[5].data()};
    const std::array<float*, 2> pixel{x_px + first, y_px + first};
    camera_.ProjectMany({points[0].data(), points[1].data(), points[2].data()}, n, pixel[0],
                        pixel[1], d_pixel_d_point ? &outputs : nullptr);
    for (int axis = 0; axis < 2; ++axis) {
      const Axis displacement = AxisOf(displacement_, axis);
      for (std::size_t i = 0; i < n; ++i) {
        pixel[axis][i] += Displacement(displacement, per_m * x[i], per_m * y[i]);
      }
      if (!d_pixel_d_point) continue;
      const Values* by = &by_point[3 * axis];
      const std::array<float*, 2> by_plane{(*d_pixel_d_point)[2 * axis] + first,
                                           (*d_pixel_d_point)[2 * axis + 1] + first};
      for (int k = 0; k < 2; ++k) {
        for (std::size_t i = 0; i < n; ++i) {
          by_plane[k][i] = by[0][i] * plane(0, k) + by[1][i] * plane(1, k) + by[2][i] * plane(2, k);
        }
      }
      AddSlopes(displacement, per_m, x, y, n, by_plane[0], by_plane[1]);
    }
  }
}

}  // namespace kestrel
