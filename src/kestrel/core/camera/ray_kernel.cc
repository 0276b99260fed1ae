// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/ray_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/core/camera/ray_kernel.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for every instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using Vector = hn::Vec<Floats>;

struct Lookup {
  Vector t;
  Vector q;
  hn::Mask<Floats> in_table;
};

// T at the squared radius of (x, y), linear between the knots; the first knot where it is outside.
HWY_INLINE Lookup LookUp(const RayKernel& kernel, Vector x, Vector y) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const Vector q = hn::MulAdd(x, x, hn::Mul(y, y));
  const auto in_table = hn::Lt(q, hn::Set(d, kernel.end_q));
  const Vector position = hn::IfThenElseZero(in_table, hn::Mul(q, hn::Set(d, kernel.cells_per_q)));
  const auto cell = hn::ConvertTo(di, position);
  const Vector fraction = hn::Sub(position, hn::ConvertTo(d, cell));
  const Vector low = hn::GatherIndex(d, kernel.table, cell);
  const Vector high = hn::GatherIndex(d, kernel.table + 1, cell);
  return {hn::MulAdd(fraction, hn::Sub(high, low), low), q, in_table};
}

HWY_INLINE void RaysOfOneVector(const RayKernel& kernel, const float* u_px, const float* v_px,
                                float* out_x, float* out_y, float* out_z) {
  const Floats d;
  const Vector one = hn::Set(d, 1.0f);
  const Vector distorted_x =
      hn::Mul(hn::Sub(hn::LoadU(d, u_px), hn::Set(d, kernel.cx_px)), hn::Set(d, kernel.inverse_fx));
  const Vector distorted_y =
      hn::Mul(hn::Sub(hn::LoadU(d, v_px), hn::Set(d, kernel.cy_px)), hn::Set(d, kernel.inverse_fy));
  Vector x = distorted_x;
  Vector y = distorted_y;
  Lookup found = LookUp(kernel, x, y);
  Vector tangent2 = hn::Mul(hn::Mul(found.t, found.t), found.q);
  for (int i = 0; i < kernel.corrections; ++i) {
    const Vector p1 = hn::Set(d, kernel.p1);
    const Vector p2 = hn::Set(d, kernel.p2);
    const Vector to_plane = hn::Div(hn::Add(found.t, found.t), hn::Sub(one, tangent2));
    const Vector plane_x = hn::Mul(to_plane, x);
    const Vector plane_y = hn::Mul(to_plane, y);
    const Vector xx = hn::Mul(plane_x, plane_x);
    const Vector yy = hn::Mul(plane_y, plane_y);
    const Vector s = hn::Add(xx, yy);
    const Vector both = hn::Mul(hn::Add(plane_x, plane_x), plane_y);
    const Vector along_x = hn::Add(s, hn::Add(xx, xx));
    const Vector along_y = hn::Add(s, hn::Add(yy, yy));
    x = hn::Sub(distorted_x, hn::MulAdd(p1, both, hn::Mul(p2, along_x)));
    y = hn::Sub(distorted_y, hn::MulAdd(p1, along_y, hn::Mul(p2, both)));
    found = LookUp(kernel, x, y);
    tangent2 = hn::Mul(hn::Mul(found.t, found.t), found.q);
  }
  const Vector scale = hn::Div(one, hn::Add(one, tangent2));
  const Vector z = hn::Mul(hn::Sub(one, tangent2), scale);
  const auto valid = hn::And(found.in_table, hn::Ge(z, hn::Set(d, kernel.min_z)));
  const Vector to_ray = hn::Mul(hn::Add(found.t, found.t), scale);
  hn::StoreU(hn::IfThenElseZero(valid, hn::Mul(to_ray, x)), d, out_x);
  hn::StoreU(hn::IfThenElseZero(valid, hn::Mul(to_ray, y)), d, out_y);
  hn::StoreU(hn::IfThenElseZero(valid, z), d, out_z);
}

void ComputeRays(const RayKernel& kernel, const float* u_px, const float* v_px, std::size_t count,
                 float* x, float* y, float* z) {
  const std::size_t lanes = hn::Lanes(Floats());
  if (count < lanes) {
    for (std::size_t i = 0; i < count; ++i) {
      float ray[3];
      ComputeRay(kernel, u_px[i], v_px[i], ray);
      x[i] = ray[0];
      y[i] = ray[1];
      z[i] = ray[2];
    }
    return;
  }
  for (std::size_t i = 0; i + lanes <= count; i += lanes) {
    RaysOfOneVector(kernel, u_px + i, v_px + i, x + i, y + i, z + i);
  }
  // The last vector overlaps the one before: some points are computed twice.
  const std::size_t last = count - lanes;
  RaysOfOneVector(kernel, u_px + last, v_px + last, x + last, y + last, z + last);
}

}  // namespace HWY_NAMESPACE
}  // namespace kestrel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kestrel {

HWY_EXPORT(ComputeRays);

void ComputeRays(const RayKernel& kernel, const float* u_px, const float* v_px, std::size_t count,
                 float* x, float* y, float* z) {
  HWY_DYNAMIC_DISPATCH(ComputeRays)(kernel, u_px, v_px, count, x, y, z);
}

}  // namespace kestrel
#endif  // HWY_ONCE
