// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/projection_kernel.h"

#include <limits>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/core/camera/projection_kernel.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for every instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A vector of points on the image plane of a lens of focal length 1.
template <class D>
struct DistortedPoints {
  hn::Vec<D> x, y;
  hn::Mask<D> valid;
  std::array<hn::Vec<D>, 6> by_point;
};

template <class D>
struct VectorPoint {
  hn::Vec<D> x, y, z;
};

// Evaluates the polynomial with the given coefficients.
template <class D, std::size_t kCount>
HWY_INLINE hn::Vec<D> Polynomial(D d, hn::Vec<D> s, const std::array<float, kCount>& coefficients) {
  hn::Vec<D> value = hn::Set(d, coefficients.back());
  for (std::size_t i = kCount - 1; i-- > 0;) {
    value = hn::MulAdd(value, s, hn::Set(d, coefficients[i]));
  }
  return value;
}

// Arc tangent of t from 0 to 1, to two units in the last place: t (1 + t^2 (c0 + c1 t^2 + ...)),
// minimax (SLEEF's atanf).
template <class D>
HWY_INLINE hn::Vec<D> Atan(D d, hn::Vec<D> t) {
  constexpr std::array<float, 8> kCoefficients{-0.333331019f,  0.199926957f,  -0.142027363f,
                                               0.106347933f,   -0.074890092f, 0.0425049886f,
                                               -0.0159569029f, 0.00282363896f};
  const auto square = hn::Mul(t, t);
  return hn::MulAdd(hn::Mul(t, square), Polynomial(d, square, kCoefficients), t);
}

template <class D>
HWY_INLINE DistortedPoints<D> DistortEquidistant(D d, const ProjectionKernel& lens,
                                                 const VectorPoint<D>& p) {
  const auto& k = lens.k;
  const auto one = hn::Set(d, 1.0f);
  const auto rho2 = hn::MulAdd(p.x, p.x, hn::Mul(p.y, p.y));
  const auto norm2 = hn::MulAdd(p.z, p.z, rho2);
  const auto norm = hn::Sqrt(norm2);
  // Points on the axis are treated as close beside it.
  const auto rho = hn::Max(hn::Sqrt(rho2), hn::Mul(norm, hn::Set(d, 1e-9f)));
  // Half the angle to the nearer end of the axis is accurate everywhere.
  const auto half = Atan(d, hn::Div(rho, hn::Add(norm, hn::Abs(p.z))));
  const auto acute = hn::Add(half, half);
  const auto is_behind = hn::Lt(p.z, hn::Zero(d));
  const auto theta =
      hn::IfThenElse(is_behind, hn::Sub(hn::Set(d, std::numbers::pi_v<float>), acute), acute);
  const auto s = hn::Mul(theta, theta);
  const auto radius = hn::Mul(theta, Polynomial(d, s, std::array{1.0f, k[0], k[1], k[2], k[3]}));
  const auto slope = Polynomial(d, s, std::array{1.0f, 3 * k[0], 5 * k[1], 7 * k[2], 9 * k[3]});
  const auto inverse_rho = hn::Div(one, rho);
  const auto across = hn::Mul(radius, inverse_rho);
  DistortedPoints<D> result;
  result.x = hn::Mul(across, p.x);
  result.y = hn::Mul(across, p.y);
  const auto is_finite = hn::Lt(norm2, hn::Set(d, std::numeric_limits<float>::max()));
  const auto has_side = hn::Or(hn::Not(is_behind), hn::Gt(rho2, hn::Zero(d)));
  result.valid = hn::And(hn::And(is_finite, has_side), hn::Le(theta, hn::Set(d, lens.limit)));
  const auto cosine = hn::Mul(p.x, inverse_rho);
  const auto sine = hn::Mul(p.y, inverse_rho);
  const auto scaled = hn::Div(slope, norm2);
  const auto difference = hn::MulSub(scaled, p.z, across);
  const auto depth = hn::Mul(hn::Neg(scaled), rho);
  const auto mixed = hn::Mul(hn::Mul(cosine, sine), difference);
  result.by_point = {hn::MulAdd(hn::Mul(cosine, cosine), difference, across),
                     mixed,
                     hn::Mul(cosine, depth),
                     mixed,
                     hn::MulAdd(hn::Mul(sine, sine), difference, across),
                     hn::Mul(sine, depth)};
  return result;
}

template <class D>
HWY_INLINE DistortedPoints<D> DistortPinhole(D d, const ProjectionKernel& lens,
                                             const VectorPoint<D>& p) {
  const auto& k = lens.k;
  const auto inverse_z = hn::Div(hn::Set(d, 1.0f), p.z);
  const auto x = hn::Mul(p.x, inverse_z);
  const auto y = hn::Mul(p.y, inverse_z);
  const auto xx = hn::Mul(x, x);
  const auto yy = hn::Mul(y, y);
  const auto s = hn::Add(xx, yy);
  const auto inverse =
      hn::Div(hn::Set(d, 1.0f), Polynomial(d, s, std::array{1.0f, k[5], k[6], k[7]}));
  const auto factor = hn::Mul(Polynomial(d, s, std::array{1.0f, k[0], k[1], k[4]}), inverse);
  const auto growth = Polynomial(d, s, std::array{k[0], 2 * k[1], 3 * k[4]});
  const auto shrinkage = Polynomial(d, s, std::array{k[5], 2 * k[6], 3 * k[7]});
  const auto slope = hn::Mul(hn::NegMulAdd(factor, shrinkage, growth), inverse);
  const auto twice_slope = hn::Add(slope, slope);
  const auto p1 = hn::Set(d, k[2]);
  const auto p2 = hn::Set(d, k[3]);
  const auto tangential_x = hn::MulAdd(p1, y, hn::Mul(p2, x));
  DistortedPoints<D> result;
  // Tangential part: x and y times 2 (p1 y + p2 x), and p2 or p1 times s.
  const auto both = hn::MulAdd(hn::Set(d, 2.0f), tangential_x, factor);
  result.x = hn::MulAdd(both, x, hn::Mul(p2, s));
  result.y = hn::MulAdd(both, y, hn::Mul(p1, s));
  result.valid = hn::And(hn::Gt(p.z, hn::Zero(d)), hn::Le(s, hn::Set(d, lens.limit * lens.limit)));
  const auto four = hn::Set(d, 4.0f);
  const auto mixed = hn::Add(hn::Mul(twice_slope, hn::Mul(x, y)),
                             hn::Mul(hn::Set(d, 2.0f), hn::MulAdd(p1, x, hn::Mul(p2, y))));
  const auto x_by_x = hn::MulAdd(twice_slope, xx, hn::MulAdd(four, hn::Mul(p2, x), both));
  const auto y_by_y = hn::MulAdd(twice_slope, yy, hn::MulAdd(four, hn::Mul(p1, y), both));
  const auto depth = [&](auto by_x, auto by_y) HWY_ATTR {
    return hn::Mul(hn::Neg(inverse_z), hn::MulAdd(by_x, x, hn::Mul(by_y, y)));
  };
  const auto mixed_z = hn::Mul(mixed, inverse_z);
  result.by_point = {hn::Mul(x_by_x, inverse_z), mixed_z,
                     depth(x_by_x, mixed),       mixed_z,
                     hn::Mul(y_by_y, inverse_z), depth(mixed, y_by_y)};
  return result;
}

template <class D>
HWY_INLINE void ProjectVector(D d, const ProjectionKernel& lens,
                              const std::array<const float*, 3>& points, std::size_t i, float* x_px,
                              float* y_px, const std::array<float*, 6>* d_pixel) {
  const VectorPoint<D> point{hn::LoadU(d, points[0] + i), hn::LoadU(d, points[1] + i),
                             hn::LoadU(d, points[2] + i)};
  const DistortedPoints<D> distorted =
      lens.is_equidistant ? DistortEquidistant(d, lens, point) : DistortPinhole(d, lens, point);
  const auto nothing = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  const auto put = [&](auto values, float* column) HWY_ATTR {
    hn::StoreU(hn::IfThenElse(distorted.valid, values, nothing), d, column + i);
  };
  const auto fx = hn::Set(d, lens.fx_px);
  const auto fy = hn::Set(d, lens.fy_px);
  put(hn::MulAdd(fx, distorted.x, hn::Set(d, lens.cx_px)), x_px);
  put(hn::MulAdd(fy, distorted.y, hn::Set(d, lens.cy_px)), y_px);
  if (d_pixel == nullptr) return;
  for (std::size_t k = 0; k < 6; ++k) {
    put(hn::Mul(k < 3 ? fx : fy, distorted.by_point[k]), (*d_pixel)[k]);
  }
}

void ProjectPoints(const ProjectionKernel& lens, const std::array<const float*, 3>& points,
                   std::size_t count, float* x_px, float* y_px,
                   const std::array<float*, 6>* d_pixel_d_point) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  if (count < lanes) {
    const hn::CappedTag<float, 1> one;
    for (std::size_t i = 0; i < count; ++i) {
      ProjectVector(one, lens, points, i, x_px, y_px, d_pixel_d_point);
    }
    return;
  }
  for (std::size_t i = 0; i + lanes <= count; i += lanes) {
    ProjectVector(d, lens, points, i, x_px, y_px, d_pixel_d_point);
  }
  // The last vector overlaps the one before: some points are computed twice.
  ProjectVector(d, lens, points, count - lanes, x_px, y_px, d_pixel_d_point);
}

}  // namespace HWY_NAMESPACE
}  // namespace kestrel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kestrel {

HWY_EXPORT(ProjectPoints);

void ProjectPoints(const ProjectionKernel& kernel, const std::array<const float*, 3>& points,
                   std::size_t count, float* x_px, float* y_px,
                   const std::array<float*, 6>* d_pixel_d_point) {
  HWY_DYNAMIC_DISPATCH(ProjectPoints)(kernel, points, count, x_px, y_px, d_pixel_d_point);
}

}  // namespace kestrel
#endif  // HWY_ONCE
