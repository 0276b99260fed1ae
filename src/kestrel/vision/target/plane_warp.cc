// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/target/plane_warp.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/vision/target/plane_warp.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for every instruction set.
#include <hwy/highway.h>

#ifndef KESTREL_TARGET_PLANE_WARP_CC_
#define KESTREL_TARGET_PLANE_WARP_CC_
namespace kestrel {

// A warp in single precision.
struct WarpKernel {
  Eigen::Matrix<float, 3, 2> plane;
  float per_m;
  std::array<std::array<float, PlaneWarp::kTerms>, 2> displacement;  // by x and y
};

// Projections of as many points as are processed at once.
struct ShownPoints {
  static constexpr std::size_t kMost = 64;
  using Column = std::array<float, kMost>;

  std::array<Column, 2> pixel;
  std::array<Column, 6> by_point;
};

}  // namespace kestrel
#endif  // KESTREL_TARGET_PLANE_WARP_CC_

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// PlaneWarp::Project for a vector of points, from what the lens shows.
template <class D>
HWY_INLINE void DisplaceVector(D d, const WarpKernel& warp, const ShownPoints& shown, std::size_t i,
                               const float* x_m, const float* y_m,
                               const std::array<float*, 2>& pixel,
                               const std::array<float*, 4>* by_plane) {
  const auto of = [&](float value) HWY_ATTR { return hn::Set(d, value); };
  const auto x = hn::Mul(hn::LoadU(d, x_m + i), of(warp.per_m));
  const auto y = hn::Mul(hn::LoadU(d, y_m + i), of(warp.per_m));
  const auto square = hn::MulAdd(x, x, hn::Mul(y, y));
  for (int axis = 0; axis < 2; ++axis) {
    const auto& c = warp.displacement[axis];
    const auto by_x = hn::MulAdd(of(c[3]), x, hn::MulAdd(of(c[4]), y, of(c[1])));
    const auto by_y = hn::MulAdd(of(c[5]), y, of(c[2]));
    const auto cubic = hn::MulAdd(of(c[6]), x, hn::Mul(of(c[7]), y));
    const auto low = hn::MulAdd(x, by_x, hn::MulAdd(y, by_y, of(c[0])));
    const auto lens = hn::LoadU(d, &shown.pixel[axis][i]);
    hn::StoreU(hn::Add(lens, hn::MulAdd(square, cubic, low)), d, pixel[axis] + i);
    if (by_plane == nullptr) continue;
    const auto slope_x = hn::MulAdd(hn::Add(x, x), cubic,
                                    hn::MulAdd(square, of(c[6]), hn::MulAdd(x, of(c[3]), by_x)));
    const auto slope_y = hn::MulAdd(
        hn::Add(y, y), cubic,
        hn::MulAdd(square, of(c[7]), hn::MulAdd(x, of(c[4]), hn::MulAdd(y, of(c[5]), by_y))));
    for (int k = 0; k < 2; ++k) {
      auto slope = hn::Mul(k == 0 ? slope_x : slope_y, of(warp.per_m));
      for (int row = 0; row < 3; ++row) {
        const auto by_row = hn::LoadU(d, &shown.by_point[3 * axis + row][i]);
        slope = hn::MulAdd(by_row, of(warp.plane(row, k)), slope);
      }
      hn::StoreU(slope, d, (*by_plane)[2 * axis + k] + i);
    }
  }
}

void Displace(const WarpKernel& warp, const ShownPoints& shown, const float* x_m, const float* y_m,
              std::size_t count, const std::array<float*, 2>& pixel,
              const std::array<float*, 4>* by_plane) {
  const hn::CappedTag<float, 16> d;
  const std::size_t lanes = hn::Lanes(d);
  if (count < lanes) {
    const hn::CappedTag<float, 1> one;
    for (std::size_t i = 0; i < count; ++i) {
      DisplaceVector(one, warp, shown, i, x_m, y_m, pixel, by_plane);
    }
    return;
  }
  for (std::size_t i = 0; i + lanes <= count; i += lanes) {
    DisplaceVector(d, warp, shown, i, x_m, y_m, pixel, by_plane);
  }
  // The last vector overlaps the one before it: some points are computed twice.
  DisplaceVector(d, warp, shown, count - lanes, x_m, y_m, pixel, by_plane);
}

}  // namespace HWY_NAMESPACE
}  // namespace kestrel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kestrel {

HWY_EXPORT(Displace);

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
  const WarpKernel warp{plane_.cast<float>(),
                        static_cast<float>(1 / radius_m_),
                        {AxisOf(displacement_, 0), AxisOf(displacement_, 1)}};
  const Eigen::Vector3f center = pose_.translation.cast<float>();
  for (std::size_t first = 0; first < count; first += ShownPoints::kMost) {
    const std::size_t n = std::min(ShownPoints::kMost, count - first);
    const float* x = x_m + first;
    const float* y = y_m + first;
    std::array<ShownPoints::Column, 3> points;
    for (int k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < n; ++i) {
        points[k][i] = center(k) + warp.plane(k, 0) * x[i] + warp.plane(k, 1) * y[i];
      }
    }
    ShownPoints shown;
    std::array<float*, 6> by_point;
    for (int k = 0; k < 6; ++k) by_point[k] = shown.by_point[k].data();
    camera_.ProjectMany({points[0].data(), points[1].data(), points[2].data()}, n,
                        shown.pixel[0].data(), shown.pixel[1].data(),
                        d_pixel_d_point ? &by_point : nullptr);
    std::array<float*, 4> by_plane{};
    if (d_pixel_d_point) {
      for (int k = 0; k < 4; ++k) by_plane[k] = (*d_pixel_d_point)[k] + first;
    }
    HWY_DYNAMIC_DISPATCH(Displace)
    (warp, shown, x, y, n, {x_px + first, y_px + first}, d_pixel_d_point ? &by_plane : nullptr);
  }
}

}  // namespace kestrel
#endif  // HWY_ONCE
