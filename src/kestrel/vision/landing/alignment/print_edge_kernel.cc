// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/alignment/print_edge_kernel.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/vision/landing/alignment/print_edge_kernel.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for every instruction set.
#include <hwy/highway.h>

#include "kestrel/core/image/gray_sampling-inl.h"
#include "kestrel/vision/landing/image_properties.h"

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

using Floats = hn::CappedTag<float, 16>;
using Vector = hn::Vec<Floats>;

constexpr float kStepInShadow = 0.3f;  // in a shadow: share of the gray value of its white
constexpr float kLeastShare = 0.12f;   // least rise of the neighbours, share of the steepest rise

HWY_INLINE Vector Of(float value) { return hn::Set(Floats(), value); }
HWY_INLINE Vector At(const PlaceColumns::Column& column, std::size_t i) {
  return hn::LoadU(Floats(), column.data() + i);
}
HWY_INLINE void Put(Vector values, PlaceColumns::Column* column, std::size_t i) {
  hn::StoreU(values, Floats(), column->data() + i);
}

// Columns are as long as whole vectors; values beyond 'count' are computed and not used.
void TurnNormals(std::size_t count, PlaceColumns* places) {
  for (std::size_t i = 0; i < count; i += hn::Lanes(Floats())) {
    const Vector x_by_x = At(places->by_place[0], i), x_by_y = At(places->by_place[1], i);
    const Vector y_by_x = At(places->by_place[2], i), y_by_y = At(places->by_place[3], i);
    const Vector normal_x = At(places->normal_x, i), normal_y = At(places->normal_y, i);
    // At right angles to the image of the tangent, on the side of the plane's normal.
    const Vector tangent_x = hn::MulSub(x_by_y, normal_x, hn::Mul(x_by_x, normal_y));
    const Vector tangent_y = hn::MulSub(y_by_y, normal_x, hn::Mul(y_by_x, normal_y));
    const Vector determinant = hn::MulSub(x_by_x, y_by_y, hn::Mul(x_by_y, y_by_x));
    const Vector per_length =
        hn::Div(Of(1), hn::Sqrt(hn::MulAdd(tangent_x, tangent_x, hn::Mul(tangent_y, tangent_y))));
    const Vector per_side = hn::CopySign(per_length, determinant);
    Put(hn::Mul(tangent_y, per_side), &places->across_x, i);
    Put(hn::Neg(hn::Mul(tangent_x, per_side)), &places->across_y, i);
    const Vector px_per_m = hn::Mul(hn::Abs(determinant), per_length);
    Put(px_per_m, &places->px_per_m, i);
    Put(hn::Mul(hn::Mul(Of(0.5f), px_per_m), hn::Mul(per_length, per_length)), &places->bend, i);
  }
}

// Binary logarithm of a positive normal number, to 0.01: exponent plus a parabola in the mantissa.
HWY_INLINE Vector Log2(Vector value) {
  constexpr int kMantissaBits = 23;
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const auto bits = hn::BitCast(di, value);
  const auto exponent = hn::Sub(hn::ShiftRight<kMantissaBits>(bits), hn::Set(di, 127));
  const auto mantissa = hn::And(bits, hn::Set(di, (1 << kMantissaBits) - 1));
  const Vector t = hn::Mul(hn::ConvertTo(d, mantissa), Of(1.0f / (1 << kMantissaBits)));
  return hn::MulAdd(t, hn::NegMulAdd(Of(0.3465f), t, Of(1.3465f)), hn::ConvertTo(d, exponent));
}

// Returns the offset of the peak of three rises. The rise across a blurred edge is a Gaussian, so
// its logarithm is a parabola. A parabola through the rises themselves would fall short of the edge
// by a third.
HWY_INLINE Vector PeakOf(Vector before, Vector here, Vector after) {
  const Vector least = hn::Mul(Of(kLeastShare), here);
  const Vector log_before = Log2(hn::Max(before, least));
  const Vector log_after = Log2(hn::Max(after, least));
  const Vector log_here = Log2(here);
  const Vector curvature = hn::Sub(hn::Add(log_before, log_after), hn::Add(log_here, log_here));
  const Vector shift = hn::Div(hn::Mul(Of(0.5f), hn::Sub(log_before, log_after)), curvature);
  return hn::IfThenElseZero(hn::Lt(curvature, hn::Zero(Floats())),
                            hn::Max(hn::Min(shift, Of(0.5f)), Of(-0.5f)));
}

HWY_INLINE Vector SearchVector(const cv::Mat& image, int reach, float min_step, Vector x, Vector y,
                               Vector across_x, Vector across_y) {
  const Floats d;
  const Vector zero = hn::Zero(d);
  const auto sample = [&](float away) HWY_ATTR {
    return SampleVector(d, image, hn::MulAdd(Of(away), across_x, x),
                        hn::MulAdd(Of(away), across_y, y));
  };
  // Gray values from a pixel and a half before the window's reach onwards, in steps of a pixel.
  const float first = -static_cast<float>(reach) - 1.5f;
  const Vector gray = sample(first);
  Vector current = sample(first + 1);
  auto is_shown = hn::And(hn::Ge(gray, zero), hn::Ge(current, zero));
  Vector last_rise = hn::Sub(current, gray);
  Vector best_rise = Of(GrayContrast::kLeast), best = zero, before = zero, after = zero,
         white = Of(1e9f);
  auto is_best = hn::Lt(zero, zero);
  for (int i = -reach; i <= reach + 1; ++i) {
    const Vector next = sample(static_cast<float>(i) + 0.5f);
    is_shown = hn::And(is_shown, hn::Ge(next, zero));
    const Vector rise = hn::Sub(next, current);
    after = hn::IfThenElse(is_best, rise, after);
    if (i <= reach) {
      is_best = hn::Gt(rise, best_rise);
      best_rise = hn::IfThenElse(is_best, rise, best_rise);
      best = hn::IfThenElse(is_best, Of(static_cast<float>(i)), best);
      before = hn::IfThenElse(is_best, last_rise, before);
      white = hn::IfThenElse(is_best, next, white);
    }
    last_rise = rise;
    current = next;
  }
  // In a shadow the print's contrast is lower, and so is its white.
  const auto is_edge =
      hn::And(hn::Gt(best_rise, Of(GrayContrast::kLeast)),
              hn::Ge(best_rise, hn::Min(Of(min_step), hn::Mul(Of(kStepInShadow), white))));
  const Vector offset = hn::Add(best, PeakOf(before, best_rise, after));
  return hn::IfThenElse(is_shown,
                        hn::IfThenElse(is_edge, offset, Of(std::numeric_limits<float>::infinity())),
                        Of(std::numeric_limits<float>::quiet_NaN()));
}

void SearchEdges(const cv::Mat& image, const EdgeWindow& window, std::size_t count,
                 PlaceColumns* places) {
  for (std::size_t i = 0; i < count; i += hn::Lanes(Floats())) {
    const auto in_image = [&](const PlaceColumns::Column& pixels, float offset) HWY_ATTR {
      return hn::MulAdd(Of(window.scale), At(pixels, i), Of(offset));
    };
    Put(SearchVector(image, window.reach, window.min_step, in_image(places->x_px, window.offset_x),
                     in_image(places->y_px, window.offset_y), At(places->across_x, i),
                     At(places->across_y, i)),
        &places->offset_px, i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace kestrel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kestrel {

HWY_EXPORT(TurnNormals);
HWY_EXPORT(SearchEdges);

void TurnNormals(std::size_t count, PlaceColumns* places) {
  HWY_DYNAMIC_DISPATCH(TurnNormals)(count, places);
}

void SearchEdges(const cv::Mat& image, const EdgeWindow& window, std::size_t count,
                 PlaceColumns* places) {
  HWY_DYNAMIC_DISPATCH(SearchEdges)(image, window, count, places);
}

}  // namespace kestrel
#endif  // HWY_ONCE
