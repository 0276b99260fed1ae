// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/small_pattern_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/vision/landing/small_pattern_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using Vector = hn::Vec<Floats>;

HWY_INLINE Vector Of(float value) { return hn::Set(Floats(), value); }
HWY_INLINE Vector At(const std::vector<float>& column, std::size_t i) {
  return hn::LoadU(Floats(), column.data() + i);
}
HWY_INLINE void Put(Vector values, std::vector<float>* column, std::size_t i) {
  hn::StoreU(values, Floats(), column->data() + i);
}
HWY_INLINE Vector Dot(Vector a, Vector b, Vector c, const float* weights) {
  return hn::MulAdd(a, Of(weights[0]), hn::MulAdd(b, Of(weights[1]), hn::Mul(c, Of(weights[2]))));
}
HWY_INLINE Vector Length(Vector a, Vector b) { return hn::Sqrt(hn::MulAdd(a, a, hn::Mul(b, b))); }

// Blurred step from 0 to 1 over a distance in standard deviations of the blur: the integral of the
// biweight kernel of variance one, which is near to a Gaussian and ends at sqrt(7).
struct Step {
  Vector value;
  Vector slope;
};
HWY_INLINE Step BlurredStep(Vector z) {
  constexpr float kReach = 2.6457513f;
  const Vector one = Of(1);
  const Vector t = hn::Max(hn::Min(hn::Mul(z, Of(1 / kReach)), one), Of(-1));
  const Vector square = hn::Mul(t, t);
  const Vector rest = hn::Sub(one, square);
  const Vector inner = hn::NegMulAdd(square, Of(3.0f / 16), Of(10.0f / 16));
  const Vector outer = hn::NegMulAdd(square, inner, Of(15.0f / 16));
  return {hn::MulAdd(t, outer, Of(0.5f)), hn::Mul(hn::Mul(rest, rest), Of(15.0f / 16 / kReach))};
}

// A blurred stroke: 1 where a distance lies between two limits.
struct Stroke {
  Vector value;
  Vector by_distance;
  Vector by_log_blur;
};
HWY_INLINE Stroke BlurredStroke(Vector distance, float low, float high, Vector inverse_blur) {
  const Vector z_low = hn::Mul(hn::Sub(distance, Of(low)), inverse_blur);
  const Vector z_high = hn::Mul(hn::Sub(distance, Of(high)), inverse_blur);
  const Step a = BlurredStep(z_low);
  const Step b = BlurredStep(z_high);
  return {hn::Sub(a.value, b.value), hn::Mul(hn::Sub(a.slope, b.slope), inverse_blur),
          hn::Sub(hn::Mul(b.slope, z_high), hn::Mul(a.slope, z_low))};
}

HWY_INLINE Vector InverseBlur(float blur_px, Vector m_per_px) {
  return hn::Div(Of(1), hn::Max(hn::Mul(Of(blur_px), m_per_px), Of(1e-9f)));
}

void EvaluatePrint(const PrintModel& model, SmallPatternWorkspace* workspace) {
  const SmallPatternWorkspace::Pixels& pixels = workspace->pixels;
  SmallPatternWorkspace::Points& points = workspace->points;
  const Vector one = Of(1);
  const float half_width = model.arm_half_width_m;
  const float length = model.arm_half_length_m;
  for (std::size_t i = 0; i < workspace->count; i += hn::Lanes(Floats())) {
    const auto homogeneous = [&](const std::array<std::vector<float>, 3>& ray, int row) HWY_ATTR {
      return Dot(At(ray[0], i), At(ray[1], i), At(ray[2], i), &model.plane_from_ray[3 * row]);
    };
    const Vector w = hn::Div(one, homogeneous(pixels.ray, 2));
    const Vector x = hn::Mul(homogeneous(pixels.ray, 0), w);
    const Vector y = hn::Mul(homogeneous(pixels.ray, 1), w);
    const Vector depth_by_u = homogeneous(pixels.ray_by_u, 2);
    const Vector depth_by_v = homogeneous(pixels.ray_by_v, 2);
    const Vector x_by_u = hn::Mul(hn::NegMulAdd(x, depth_by_u, homogeneous(pixels.ray_by_u, 0)), w);
    const Vector x_by_v = hn::Mul(hn::NegMulAdd(x, depth_by_v, homogeneous(pixels.ray_by_v, 0)), w);
    const Vector y_by_u = hn::Mul(hn::NegMulAdd(y, depth_by_u, homogeneous(pixels.ray_by_u, 1)), w);
    const Vector y_by_v = hn::Mul(hn::NegMulAdd(y, depth_by_v, homogeneous(pixels.ray_by_v, 1)), w);

    const Vector radius = hn::Max(Length(x, y), Of(1e-9f));
    const Vector inverse_radius = hn::Div(one, radius);
    const Vector cosine = hn::Mul(x, inverse_radius);
    const Vector sine = hn::Mul(y, inverse_radius);
    const Vector r_by_u = hn::MulAdd(cosine, x_by_u, hn::Mul(sine, y_by_u));
    const Vector r_by_v = hn::MulAdd(cosine, x_by_v, hn::Mul(sine, y_by_v));
    const Vector t_by_u = hn::MulSub(cosine, y_by_u, hn::Mul(sine, x_by_u));
    const Vector t_by_v = hn::MulSub(cosine, y_by_v, hn::Mul(sine, x_by_v));
    // Blur along the ring mixes in points farther from its centre; to second order the blurred ring
    // is narrower by half of this. Without this term small prints seem farther away by half a
    // percent.
    const Vector bend = hn::Mul(hn::Mul(Of(0.5f * model.blur_px * model.blur_px), inverse_radius),
                                hn::MulAdd(t_by_u, t_by_u, hn::Mul(t_by_v, t_by_v)));
    const Vector sharpness_r = InverseBlur(model.blur_px, Length(r_by_u, r_by_v));
    const Vector sharpness_x = InverseBlur(model.blur_px, Length(x_by_u, x_by_v));
    const Vector sharpness_y = InverseBlur(model.blur_px, Length(y_by_u, y_by_v));
    const Stroke ring = BlurredStroke(hn::Add(radius, bend), model.inner_radius_m,
                                      model.outer_radius_m, sharpness_r);
    const Stroke x_across = BlurredStroke(y, -half_width, half_width, sharpness_y);
    const Stroke x_along = BlurredStroke(x, -length, length, sharpness_x);
    const Stroke y_across = BlurredStroke(x, -half_width, half_width, sharpness_x);
    const Stroke y_along = BlurredStroke(y, -length, length, sharpness_y);
    const Vector arm_x = hn::Mul(x_across.value, x_along.value);
    const Vector arm_y = hn::Mul(y_across.value, y_along.value);
    const Vector no_ring = hn::Sub(one, ring.value);
    const Vector no_x = hn::Sub(one, arm_x);
    const Vector no_y = hn::Sub(one, arm_y);
    const Vector by_ring = hn::Mul(no_x, no_y);
    const Vector by_r = hn::Mul(by_ring, ring.by_distance);
    const Vector by_arm_x = hn::Mul(no_ring, no_y);
    const Vector by_arm_y = hn::Mul(no_ring, no_x);
    const auto by_product =
        [](const Stroke& a, Vector by_a, const Stroke& b, Vector by_b)
            HWY_ATTR { return hn::MulAdd(by_a, b.value, hn::Mul(a.value, by_b)); };

    Put(x, &points.x, i);
    Put(y, &points.y, i);
    Put(x_by_u, &points.x_by_u, i);
    Put(x_by_v, &points.x_by_v, i);
    Put(y_by_u, &points.y_by_u, i);
    Put(y_by_v, &points.y_by_v, i);
    Put(ring.value, &points.ring, i);
    Put(arm_x, &points.arm_x, i);
    Put(arm_y, &points.arm_y, i);
    Put(hn::NegMulAdd(no_ring, by_ring, one), &points.dark, i);
    Put(hn::MulAdd(by_r, cosine,
                   hn::MulAdd(by_arm_x, hn::Mul(x_across.value, x_along.by_distance),
                              hn::Mul(by_arm_y, hn::Mul(y_across.by_distance, y_along.value)))),
        &points.dark_by_x, i);
    Put(hn::MulAdd(by_r, sine,
                   hn::MulAdd(by_arm_x, hn::Mul(x_across.by_distance, x_along.value),
                              hn::Mul(by_arm_y, hn::Mul(y_across.value, y_along.by_distance)))),
        &points.dark_by_y, i);
    const Vector ring_by_log_blur =
        hn::MulAdd(hn::Add(bend, bend), ring.by_distance, ring.by_log_blur);
    Put(hn::MulAdd(
            by_ring, ring_by_log_blur,
            hn::MulAdd(
                by_arm_x, by_product(x_across, x_across.by_log_blur, x_along, x_along.by_log_blur),
                hn::Mul(by_arm_y,
                        by_product(y_across, y_across.by_log_blur, y_along, y_along.by_log_blur)))),
        &points.dark_by_log_blur, i);
  }
}

void CompareGrays(const PrintLight& light, float limit, SmallPatternWorkspace* workspace) {
  SmallPatternWorkspace::Points& points = workspace->points;
  for (std::size_t i = 0; i < workspace->count; i += hn::Lanes(Floats())) {
    const Vector gray = At(workspace->pixels.gray, i);
    const Vector white =
        hn::MulAdd(At(points.x, i), Of(light.slope_x),
                   hn::MulAdd(At(points.y, i), Of(light.slope_y), Of(light.white)));
    const Vector expected = hn::NegMulAdd(Of(light.contrast), At(points.dark, i), white);
    // A saturated pixel of which more is expected counts as showing what is expected.
    const auto cut_off = hn::And(hn::Ge(gray, Of(light.saturated)), hn::Gt(expected, gray));
    const Vector seen = hn::IfThenElse(cut_off, expected, gray);
    const Vector residual = hn::Sub(seen, expected);
    const Vector magnitude = hn::Max(hn::Abs(residual), Of(1e-6f));
    Put(expected, &points.expected, i);
    Put(hn::Min(seen, hn::Add(white, Of(light.highlight))), &points.seen, i);
    Put(residual, &points.residual, i);
    const Vector weight = hn::Min(Of(1), hn::Div(Of(limit), magnitude));
    Put(weight, &points.weight, i);
    // A saturated pixel does not count for small changes.
    Put(hn::IfThenZeroElse(cut_off, hn::Sqrt(weight)), &points.root_weight, i);
  }
}

void Differentiate(const PrintAxes& axes, float contrast, SmallPatternWorkspace* workspace) {
  const SmallPatternWorkspace::Pixels& pixels = workspace->pixels;
  const SmallPatternWorkspace::Points& points = workspace->points;
  auto& jacobian = workspace->jacobian;
  for (std::size_t i = 0; i < workspace->count; i += hn::Lanes(Floats())) {
    const Vector root = At(points.root_weight, i);
    // A moved point of the plane stays on the ray of its pixel. The component of the motion within
    // the plane, along the ray, moves the print under the pixel the other way.
    const Vector ray_x = At(pixels.ray[0], i);
    const Vector ray_y = At(pixels.ray[1], i);
    const Vector ray_z = At(pixels.ray[2], i);
    const Vector by_x = hn::Mul(At(points.dark_by_x, i), Of(contrast));
    const Vector by_y = hn::Mul(At(points.dark_by_y, i), Of(contrast));
    const Vector along_ray =
        hn::Div(hn::MulAdd(by_x, Dot(ray_x, ray_y, ray_z, axes.x.data()),
                           hn::Mul(by_y, Dot(ray_x, ray_y, ray_z, axes.y.data()))),
                Dot(ray_x, ray_y, ray_z, axes.normal.data()));
    const auto component = [&](int k) HWY_ATTR {
      return hn::Mul(root, hn::MulAdd(by_x, Of(axes.x[k]),
                                      hn::NegMulAdd(along_ray, Of(axes.normal[k]),
                                                    hn::Mul(by_y, Of(axes.y[k])))));
    };
    const Vector px = component(0), py = component(1), pz = component(2);
    const Vector x = At(points.x, i), y = At(points.y, i);
    const auto from_center = [&](int k) HWY_ATTR {
      return hn::MulAdd(x, Of(axes.x[k]), hn::Mul(y, Of(axes.y[k])));
    };
    const Vector cx = from_center(0), cy = from_center(1), cz = from_center(2);
    Put(px, &jacobian[0], i);
    Put(py, &jacobian[1], i);
    Put(pz, &jacobian[2], i);
    Put(hn::MulSub(cy, pz, hn::Mul(cz, py)), &jacobian[3], i);
    Put(hn::MulSub(cz, px, hn::Mul(cx, pz)), &jacobian[4], i);
    Put(hn::MulSub(cx, py, hn::Mul(cy, px)), &jacobian[5], i);
    Put(hn::Mul(root, hn::Mul(Of(-contrast), At(points.dark_by_log_blur, i))), &jacobian[6], i);
    Put(root, &jacobian[7], i);
    Put(hn::Neg(hn::Mul(root, At(points.dark, i))), &jacobian[8], i);
    Put(hn::Mul(root, x), &jacobian[9], i);
    Put(hn::Mul(root, y), &jacobian[10], i);
    Put(hn::Mul(root, At(points.residual, i)), &jacobian[11], i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace kestrel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kestrel {

HWY_EXPORT(EvaluatePrint);
HWY_EXPORT(CompareGrays);
HWY_EXPORT(Differentiate);

void EvaluatePrint(const PrintModel& model, SmallPatternWorkspace* workspace) {
  HWY_DYNAMIC_DISPATCH(EvaluatePrint)(model, workspace);
}

void CompareGrays(const PrintLight& light, float limit, SmallPatternWorkspace* workspace) {
  HWY_DYNAMIC_DISPATCH(CompareGrays)(light, limit, workspace);
}

void Differentiate(const PrintAxes& axes, float contrast, SmallPatternWorkspace* workspace) {
  HWY_DYNAMIC_DISPATCH(Differentiate)(axes, contrast, workspace);
}

}  // namespace kestrel
#endif  // HWY_ONCE
