// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/small_pattern/small_pattern_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/vision/landing/small_pattern/small_pattern_kernel.cc"
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

// The point where a pixel's ray meets the plane of the print, m, and its derivatives by the pixel.
struct PlanePoint {
  Vector x, y;
  Vector x_by_u, x_by_v, y_by_u, y_by_v;
};

HWY_INLINE PlanePoint MeetPlane(const PrintModel& model,
                                const SmallPatternWorkspace::Pixels& pixels, std::size_t i) {
  const auto homogeneous = [&](const std::array<std::vector<float>, 3>& ray, int row) HWY_ATTR {
    return Dot(At(ray[0], i), At(ray[1], i), At(ray[2], i), &model.plane_from_ray[3 * row]);
  };
  const Vector w = hn::Div(Of(1), homogeneous(pixels.ray, 2));
  PlanePoint point;
  point.x = hn::Mul(homogeneous(pixels.ray, 0), w);
  point.y = hn::Mul(homogeneous(pixels.ray, 1), w);
  const Vector depth_by_u = homogeneous(pixels.ray_by_u, 2);
  const Vector depth_by_v = homogeneous(pixels.ray_by_v, 2);
  const auto moved = [&](Vector at, Vector depth_by, Vector by)
                         HWY_ATTR { return hn::Mul(hn::NegMulAdd(at, depth_by, by), w); };
  point.x_by_u = moved(point.x, depth_by_u, homogeneous(pixels.ray_by_u, 0));
  point.x_by_v = moved(point.x, depth_by_v, homogeneous(pixels.ray_by_v, 0));
  point.y_by_u = moved(point.y, depth_by_u, homogeneous(pixels.ray_by_u, 1));
  point.y_by_v = moved(point.y, depth_by_v, homogeneous(pixels.ray_by_v, 1));
  return point;
}

// The ring at a point: its stroke, the direction from its centre, and how it bends.
struct RingAt {
  Stroke stroke;
  Vector cosine, sine;
  Vector bend;  // m
};

HWY_INLINE RingAt BlurredRing(const PrintModel& model, const PlanePoint& at) {
  const Vector radius = hn::Max(Length(at.x, at.y), Of(1e-9f));
  const Vector inverse_radius = hn::Div(Of(1), radius);
  RingAt ring;
  ring.cosine = hn::Mul(at.x, inverse_radius);
  ring.sine = hn::Mul(at.y, inverse_radius);
  const Vector r_by_u = hn::MulAdd(ring.cosine, at.x_by_u, hn::Mul(ring.sine, at.y_by_u));
  const Vector r_by_v = hn::MulAdd(ring.cosine, at.x_by_v, hn::Mul(ring.sine, at.y_by_v));
  const Vector t_by_u = hn::MulSub(ring.cosine, at.y_by_u, hn::Mul(ring.sine, at.x_by_u));
  const Vector t_by_v = hn::MulSub(ring.cosine, at.y_by_v, hn::Mul(ring.sine, at.x_by_v));
  // Blur along the ring mixes in points farther from its centre; to second order the blurred ring
  // is narrower by half of this. Without this term small prints seem farther away by half a
  // percent.
  ring.bend = hn::Mul(hn::Mul(Of(0.5f * model.blur_px * model.blur_px), inverse_radius),
                      hn::MulAdd(t_by_u, t_by_u, hn::Mul(t_by_v, t_by_v)));
  const Vector sharpness = InverseBlur(model.blur_px, Length(r_by_u, r_by_v));
  ring.stroke = BlurredStroke(hn::Add(radius, ring.bend), model.inner_radius_m,
                              model.outer_radius_m, sharpness);
  return ring;
}

// The two arms at a point: strokes across and along each.
struct ArmsAt {
  Stroke x_across, x_along, y_across, y_along;
};

HWY_INLINE ArmsAt BlurredArms(const PrintModel& model, const PlanePoint& at) {
  const float half_width = model.arm_half_width_m;
  const float length = model.arm_half_length_m;
  const Vector sharpness_x = InverseBlur(model.blur_px, Length(at.x_by_u, at.x_by_v));
  const Vector sharpness_y = InverseBlur(model.blur_px, Length(at.y_by_u, at.y_by_v));
  return {BlurredStroke(at.y, -half_width, half_width, sharpness_y),
          BlurredStroke(at.x, -length, length, sharpness_x),
          BlurredStroke(at.x, -half_width, half_width, sharpness_x),
          BlurredStroke(at.y, -length, length, sharpness_y)};
}

HWY_INLINE void PutPoint(const PlanePoint& at, std::size_t i,
                         SmallPatternWorkspace::Points* points) {
  Put(at.x, &points->x, i);
  Put(at.y, &points->y, i);
  Put(at.x_by_u, &points->x_by_u, i);
  Put(at.x_by_v, &points->x_by_v, i);
  Put(at.y_by_u, &points->y_by_u, i);
  Put(at.y_by_v, &points->y_by_v, i);
}

// The parts overlap: a point is white where none of them covers it.
HWY_INLINE void PutDarkness(const RingAt& ring, const ArmsAt& arms, std::size_t i,
                            SmallPatternWorkspace::Points* points) {
  const auto& [x_across, x_along, y_across, y_along] = arms;
  const Vector one = Of(1);
  const Vector arm_x = hn::Mul(x_across.value, x_along.value);
  const Vector arm_y = hn::Mul(y_across.value, y_along.value);
  const Vector no_ring = hn::Sub(one, ring.stroke.value);
  const Vector no_x = hn::Sub(one, arm_x);
  const Vector no_y = hn::Sub(one, arm_y);
  const Vector by_ring = hn::Mul(no_x, no_y);
  const Vector by_r = hn::Mul(by_ring, ring.stroke.by_distance);
  const Vector by_arm_x = hn::Mul(no_ring, no_y);
  const Vector by_arm_y = hn::Mul(no_ring, no_x);
  Put(ring.stroke.value, &points->ring, i);
  Put(arm_x, &points->arm_x, i);
  Put(arm_y, &points->arm_y, i);
  Put(hn::NegMulAdd(no_ring, by_ring, one), &points->dark, i);
  Put(hn::MulAdd(by_r, ring.cosine,
                 hn::MulAdd(by_arm_x, hn::Mul(x_across.value, x_along.by_distance),
                            hn::Mul(by_arm_y, hn::Mul(y_across.by_distance, y_along.value)))),
      &points->dark_by_x, i);
  Put(hn::MulAdd(by_r, ring.sine,
                 hn::MulAdd(by_arm_x, hn::Mul(x_across.by_distance, x_along.value),
                            hn::Mul(by_arm_y, hn::Mul(y_across.value, y_along.by_distance)))),
      &points->dark_by_y, i);
  const auto by_log_blur = [](const Stroke& a, const Stroke& b) HWY_ATTR {
    return hn::MulAdd(a.by_log_blur, b.value, hn::Mul(a.value, b.by_log_blur));
  };
  const Vector ring_by_log_blur =
      hn::MulAdd(hn::Add(ring.bend, ring.bend), ring.stroke.by_distance, ring.stroke.by_log_blur);
  Put(hn::MulAdd(by_ring, ring_by_log_blur,
                 hn::MulAdd(by_arm_x, by_log_blur(x_across, x_along),
                            hn::Mul(by_arm_y, by_log_blur(y_across, y_along)))),
      &points->dark_by_log_blur, i);
}

void EvaluatePrint(const PrintModel& model, SmallPatternWorkspace* workspace) {
  for (std::size_t i = 0; i < workspace->count; i += hn::Lanes(Floats())) {
    const PlanePoint point = MeetPlane(model, workspace->pixels, i);
    PutPoint(point, i, &workspace->points);
    PutDarkness(BlurredRing(model, point), BlurredArms(model, point), i, &workspace->points);
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
    // A saturated pixel only shows that the light is at least as bright as the sensor's limit.
    // Where the model expects more, the pixel agrees with it: the residual is 0.
    const auto cut_off = hn::And(hn::Ge(gray, Of(light.saturated)), hn::Gt(expected, gray));
    const Vector seen = hn::IfThenElse(cut_off, expected, gray);
    const Vector residual = hn::Sub(seen, expected);
    const Vector magnitude = hn::Max(hn::Abs(residual), Of(1e-6f));
    Put(expected, &points.expected, i);
    Put(hn::Min(seen, hn::Add(white, Of(light.highlight))), &points.seen, i);
    Put(residual, &points.residual, i);
    const Vector weight = hn::Min(Of(1), hn::Div(Of(limit), magnitude));
    Put(weight, &points.weight, i);
    // A small change of the model does not change the residual of a saturated pixel: no derivative.
    Put(hn::IfThenZeroElse(cut_off, hn::Sqrt(weight)), &points.root_weight, i);
  }
}

void Differentiate(const PrintAxes& axes, float contrast, SmallPatternWorkspace* workspace) {
  const SmallPatternWorkspace::Pixels& pixels = workspace->pixels;
  const SmallPatternWorkspace::Points& points = workspace->points;
  using Columns = SmallPatternWorkspace;
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
    Put(px, &jacobian[kPoseTranslation], i);
    Put(py, &jacobian[kPoseTranslation + 1], i);
    Put(pz, &jacobian[kPoseTranslation + 2], i);
    Put(hn::MulSub(cy, pz, hn::Mul(cz, py)), &jacobian[kPoseRotation], i);
    Put(hn::MulSub(cz, px, hn::Mul(cx, pz)), &jacobian[kPoseRotation + 1], i);
    Put(hn::MulSub(cx, py, hn::Mul(cy, px)), &jacobian[kPoseRotation + 2], i);
    const Vector by_log_blur = hn::Mul(Of(-contrast), At(points.dark_by_log_blur, i));
    Put(hn::Mul(root, by_log_blur), &jacobian[Columns::kLogBlur], i);
    Put(root, &jacobian[Columns::kWhite], i);
    Put(hn::Neg(hn::Mul(root, At(points.dark, i))), &jacobian[Columns::kContrast], i);
    Put(hn::Mul(root, x), &jacobian[Columns::kSlope], i);
    Put(hn::Mul(root, y), &jacobian[Columns::kSlope + 1], i);
    Put(hn::Mul(root, At(points.residual, i)), &jacobian[Columns::kResidual], i);
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
