// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/small_pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "kestrel/landing/neighbor_correlation.h"
#include "kestrel/landing/small_pattern_model.h"

namespace kestrel {
namespace {

constexpr double kMinBlurPx = 0.4;
constexpr double kMaxBlurPx = 1.2;
constexpr int kUnknowns = 11;         // pose, blur, white, contrast, two slopes of the light
constexpr double kBlurSpread = 0.35;  // of the blur's logarithm over lenses
constexpr double kMaxWhite = 600;     // gray value of white under the strongest overexposure
// Standard deviations of the residuals beyond which one is an outlier, and the least of these,
// share of the contrast: no print is perfect.
constexpr double kOutlier = 2.5;
constexpr double kLeastNoise = 0.05;
// What looks so little like the print after so many steps never will.
constexpr int kLateStart = 3;
constexpr double kMinLateCorrelation = 0.6;
constexpr double kMaxHighlight = 0.25;  // share of the print around an arm that leaves it visible
constexpr std::size_t kMinPixels = 30;
constexpr int kMaxSide = 256;  // of the box around the print, pixels

}  // namespace

SmallPatternFitter::SmallPatternFitter(const CameraModel& camera, const RayTable& rays,
                                       const LandingPattern& pattern)
    : camera_(camera), rays_(rays), pattern_(pattern) {
  const double margin = 0.5 * pattern.board_size_m - pattern.outer_radius_m();
  extent_m_ = pattern.outer_radius_m() + std::min(1.0 * pattern.ring_width_m, 0.6 * margin);
  board_radius_m_ = pattern.outer_radius_m() + 0.6 * margin;
}

SmallPatternFitter::Darkness SmallPatternFitter::Evaluate(double x, double y,
                                                          const Eigen::Matrix2d& d_plane,
                                                          double blur_px) const {
  const double r = std::max(std::sqrt(x * x + y * y), 1e-9);
  const Eigen::Vector2d radial(x / r, y / r);
  const double blur_r = blur_px * (d_plane.transpose() * radial).norm();
  const double blur_x = blur_px * d_plane.row(0).norm();
  const double blur_y = blur_px * d_plane.row(1).norm();
  const double half_width = 0.5 * pattern_.arm_width_m;
  const double length = pattern_.arm_half_length_m;
  // What the blur mixes in from along the ring lies farther from its centre: to second order the
  // blurred ring is narrower by half of this. Left out, small prints seem farther away than they
  // are, by half a percent.
  const Eigen::Vector2d tangent(-radial.y(), radial.x());
  const double bend = blur_px * blur_px * (d_plane.transpose() * tangent).squaredNorm() / (2 * r);
  const Stroke ring =
      BlurredStroke(r + bend, pattern_.inner_radius_m(), pattern_.outer_radius_m(), blur_r);
  const Stroke x_across = BlurredStroke(y, -half_width, half_width, blur_y);
  const Stroke x_along = BlurredStroke(x, -length, length, blur_x);
  const Stroke y_across = BlurredStroke(x, -half_width, half_width, blur_x);
  const Stroke y_along = BlurredStroke(y, -length, length, blur_y);
  const double arm_x = x_across.value * x_along.value;
  const double arm_y = y_across.value * y_along.value;
  const double no_ring = 1 - ring.value, no_x = 1 - arm_x, no_y = 1 - arm_y;

  Darkness dark;
  dark.ring = ring.value;
  dark.arms = {arm_x, arm_y};
  dark.value = 1 - no_ring * no_x * no_y;
  const double by_r = no_x * no_y * ring.by_distance;
  const double by_arm_x = no_ring * no_y;
  const double by_arm_y = no_ring * no_x;
  dark.by_x = by_r * radial.x() + by_arm_x * x_across.value * x_along.by_distance +
              by_arm_y * y_across.by_distance * y_along.value;
  dark.by_y = by_r * radial.y() + by_arm_x * x_across.by_distance * x_along.value +
              by_arm_y * y_across.value * y_along.by_distance;
  dark.by_log_blur =
      no_x * no_y * (ring.by_log_blur + 2 * bend * ring.by_distance) +
      by_arm_x * (x_across.by_log_blur * x_along.value + x_across.value * x_along.by_log_blur) +
      by_arm_y * (y_across.by_log_blur * y_along.value + y_across.value * y_along.by_log_blur);
  return dark;
}

void SmallPatternWorkspace::Reserve() {
  constexpr std::size_t kMost = kEnoughToFit + 2 * kMaxSide + 1;  // of a box and its border
  pixels.reserve(kMost);
  points.reserve(kMost);
  magnitudes.reserve(kMost);
}

// Collects the pixels that show the disc of the print and the white around it under 'pose': every
// second, third, ... of every such row where a box around them has more than 'enough_pixels'.
bool SmallPatternFitter::Gather(const cv::Mat& image, const RigidTransform& pose, int enough_pixels,
                                SmallPatternWorkspace* workspace) const {
  workspace->pixels.clear();
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  for (int i = 0; i < 8; ++i) {
    const double angle = i * 0.7853981633974483;
    // The corners of an octagon around the circle.
    const double reach = extent_m_ * 1.0823922;
    Eigen::Vector2d pixel;
    if (camera_.Project(pose.translation + reach * (std::cos(angle) * rotation.col(0) +
                                                    std::sin(angle) * rotation.col(1)),
                        &pixel) == ProjectionStatus::kOutsideModel) {
      return false;
    }
    low = low.cwiseMin(pixel);
    high = high.cwiseMax(pixel);
  }
  const int x0 = std::max(0, static_cast<int>(std::floor(low.x())));
  const int y0 = std::max(0, static_cast<int>(std::floor(low.y())));
  const int x1 = std::min(image.cols - 1, static_cast<int>(std::ceil(high.x())));
  const int y1 = std::min(image.rows - 1, static_cast<int>(std::ceil(high.y())));
  if (x1 - x0 < 4 || y1 - y0 < 4 || x1 - x0 > kMaxSide || y1 - y0 > kMaxSide) return false;
  const int stride =
      1 + static_cast<int>(std::sqrt((x1 - x0) * (y1 - y0) / static_cast<double>(enough_pixels)));
  const PlaneMap map(pose);
  for (int y = y0; y <= y1; y += stride) {
    const std::uint8_t* row = image.ptr(y);
    for (int x = x0; x <= x1; x += stride) {
      const auto u = static_cast<float>(x), v = static_cast<float>(y);
      SmallPatternWorkspace::Pixel pixel;
      const Eigen::Vector3f ray = rays_.Ray(u, v);
      pixel.ray = ray.cast<double>();
      const Eigen::Vector3d h = map.inverse * pixel.ray;
      if (!(h.z() > 0) || h.head<2>().squaredNorm() > extent_m_ * extent_m_ * h.z() * h.z()) {
        continue;
      }
      // To one side only: they tell how far the blur reaches, half a pixel beside is near enough.
      pixel.d_ray_du = (rays_.Ray(u + 1, v) - ray).cast<double>();
      pixel.d_ray_dv = (rays_.Ray(u, v + 1) - ray).cast<double>();
      pixel.gray = row[x];
      workspace->pixels.push_back(pixel);
    }
  }
  return workspace->pixels.size() >= kMinPixels;
}

// Normal equations of a state for small changes of pose (translation, then rotation about the
// centre), logarithm of the blur, white, contrast and slopes; and the residuals that made them.
struct SmallPatternFitter::System {
  Eigen::Matrix<double, kUnknowns, kUnknowns> h =
      Eigen::Matrix<double, kUnknowns, kUnknowns>::Zero();
  Eigen::Matrix<double, kUnknowns, 1> b = Eigen::Matrix<double, kUnknowns, 1>::Zero();
  struct Zone {
    double squares = 0;
    int count = 0;
    double Rms() const { return std::sqrt(squares / std::max(1, count)); }
  };
  double robust_scale = 0;        // standard deviation of the residuals by their median
  std::array<Zone, 4> quadrants;  // of the inside of the ring
  Zone ring, white;
  double squares = 0;  // of the residuals
  double sum = 0;      // of the gray values
  double sum_squares = 0;
  double count = 0;
  NeighborCorrelation neighbors;  // in a row

  // Of the inside but the worst quadrant: dirt or a highlight may spoil one.
  double InsideRms() const {
    const auto worst = std::max_element(
        quadrants.begin(), quadrants.end(),
        [](const Zone& one, const Zone& other) { return one.Rms() < other.Rms(); });
    Zone others;
    for (auto zone = quadrants.begin(); zone != quadrants.end(); ++zone) {
      if (zone == worst) continue;
      others.squares += zone->squares;
      others.count += zone->count;
    }
    return others.Rms();
  }
  double variance() const { return squares / std::max(1.0, count - kUnknowns); }
  // Variance of a pixel as the pose sees it: what neighbours have in common does not average out
  // along the strokes.
  double EffectiveVariance() const {
    constexpr double kMaxCorrelation = 0.7;
    return variance() * neighbors.Redundancy(kMaxCorrelation);
  }
  double correlation() const {
    const double about_mean = sum_squares - sum * sum / count;
    return std::sqrt(std::max(0.0, 1 - squares / std::max(about_mean, 1e-9)));
  }
  // Adjusted R^2. Neighbouring pixels share their blur: of so many, one tells something new.
  double explained() const {
    constexpr double kPixelsPerSample = 4;
    const double samples = count / kPixelsPerSample;
    const double unexplained = 1 - correlation() * correlation();
    return 1 - unexplained * (samples - 1) / std::max(1.0, samples - 1 - kUnknowns);
  }
};

// Where the pixels lie on the print and how dark it is there: fills the points of the workspace.
void SmallPatternFitter::Predict(const State& state, SmallPatternWorkspace* workspace) const {
  const PlaneMap map(state.pose);
  workspace->points.clear();
  for (const auto& pixel : workspace->pixels) {
    PlanePoint point = Intersect(map, pixel);
    point.dark = Evaluate(point.x, point.y, point.by_pixel, state.blur_px).value;
    workspace->points.push_back(point);
  }
}

// The gray values of black and white where the print is predicted, by linear regression.
void SmallPatternFitter::MeasureLevels(const SmallPatternWorkspace& workspace, State* state) const {
  double n = 0, g = 0, d = 0, dd = 0, gd = 0;
  for (std::size_t i = 0; i < workspace.points.size(); ++i) {
    const double gray = workspace.pixels[i].gray;
    const double dark = workspace.points[i].dark;
    ++n;
    g += gray;
    d += dark;
    dd += dark * dark;
    gd += gray * dark;
  }
  const double spread = dd - d * d / n;
  state->contrast = spread > 1e-9 ? -(gd - g * d / n) / spread : 0;
  state->white = (g + state->contrast * d) / n;
}

// Residuals beyond 'limit' (gray values) count less, by Huber's function: highlights and dirt.
SmallPatternFitter::System SmallPatternFitter::Linearize(const State& state, double limit,
                                                         SmallPatternWorkspace* workspace) const {
  const PlaneMap map(state.pose);
  const Eigen::Vector3d normal = map.rotation.col(2);
  const double inner = pattern_.inner_radius_m();
  const double outer = pattern_.outer_radius_m() + 0.35 * pattern_.ring_width_m;
  System system;
  workspace->magnitudes.clear();
  double before = 0;
  for (const auto& pixel : workspace->pixels) {
    const PlanePoint point = Intersect(map, pixel);
    const Darkness dark = Evaluate(point.x, point.y, point.by_pixel, state.blur_px);
    const double expected = state.Gray(point, dark.value);
    const double gray = SeenGray(pixel.gray, expected);
    const double residual = gray - expected;
    const double magnitude = std::abs(residual);
    workspace->magnitudes.push_back(static_cast<float>(magnitude));
    const double weight = magnitude > limit ? limit / magnitude : 1;
    system.count += weight;
    const double clear = state.WithoutHighlight(point, gray);
    system.sum += weight * clear;
    system.sum_squares += weight * clear * clear;
    system.squares += weight * (clear - expected) * (clear - expected);
    const double radius = point.radius();
    System::Zone& zone = radius < inner   ? system.quadrants[QuadrantOf(point)]
                         : radius < outer ? system.ring
                                          : system.white;
    const double bounded = std::clamp(residual, -limit, limit);
    system.neighbors.Add(before, bounded);
    before = bounded;
    const double unexplained = std::clamp(clear - expected, -limit, limit);
    zone.squares += unexplained * unexplained;
    ++zone.count;
    if (gray != pixel.gray) continue;  // cut off: says nothing about small changes
    // A moved plane point stays on the ray of its pixel: what is left of the motion within the
    // plane, along the ray, moves the print under the pixel the other way.
    const Eigen::Vector3d from_center =
        point.x * map.rotation.col(0) + point.y * map.rotation.col(1);
    const Eigen::Vector3d shear = normal / normal.dot(pixel.ray);
    const Eigen::Vector3d bx = map.rotation.col(0) - map.rotation.col(0).dot(pixel.ray) * shear;
    const Eigen::Vector3d by = map.rotation.col(1) - map.rotation.col(1).dot(pixel.ray) * shear;
    const Eigen::Vector3d d_point = state.contrast * (dark.by_x * bx + dark.by_y * by);
    Eigen::Matrix<double, kUnknowns, 1> jacobian;
    jacobian.head<3>() = d_point;
    jacobian.segment<3>(3) = from_center.cross(d_point);
    jacobian(6) = -state.contrast * dark.by_log_blur;
    jacobian(7) = 1;
    jacobian(8) = -dark.value;
    jacobian(9) = point.x;
    jacobian(10) = point.y;
    system.h.selfadjointView<Eigen::Lower>().rankUpdate(jacobian, weight);
    system.b += jacobian * (weight * residual);
  }
  const auto middle =
      workspace->magnitudes.begin() + static_cast<std::ptrdiff_t>(workspace->magnitudes.size() / 2);
  std::nth_element(workspace->magnitudes.begin(), middle, workspace->magnitudes.end());
  system.robust_scale = 1.4826 * *middle;
  system.h.triangularView<Eigen::StrictlyUpper>() = system.h.transpose();
  return system;
}

// One Gauss-Newton step; false when it leads nowhere.
bool SmallPatternFitter::Improve(const System& system, const std::optional<NormalPrior>& prior,
                                 State* state) const {
  // The blur of a lens is known to some extent, white hardly where the image cuts it off, and the
  // direction of a small plane hardly at all: priors keep them from taking what the other
  // parameters explain.
  Eigen::Matrix<double, kUnknowns, kUnknowns> h = system.h;
  Eigen::Matrix<double, kUnknowns, 1> b = system.b;
  const double blur_weight = system.variance() / (kBlurSpread * kBlurSpread);
  h(6, 6) += blur_weight;
  b(6) -= blur_weight * std::log(state->blur_px / kGoodLensBlurPx);
  for (int i = 0; i < 6; ++i) h(i, i) *= 1.001;
  if (prior) prior->AddTo(state->pose.rotation, system.EffectiveVariance(), &h, &b);
  h(7, 7) += 0.01 * system.count;
  h(9, 9) += 1e-6 * system.count;
  h(10, 10) += 1e-6 * system.count;
  const Eigen::Matrix<double, kUnknowns, 1> step = h.ldlt().solve(b);
  if (!step.allFinite()) return false;
  RigidTransform& pose = state->pose;
  const Eigen::Vector3d turn = step.segment<3>(3);
  if (turn.norm() > 0.8 || step.head<3>().norm() > 0.5 * pose.translation.norm()) return false;
  pose = Moved(pose, step.head<3>(), turn);
  state->blur_px =
      std::clamp(state->blur_px * std::exp(std::clamp(step(6), -0.5, 0.5)), kMinBlurPx, kMaxBlurPx);
  state->white += step(7);
  state->contrast += step(8);
  state->slope += step.tail<2>();
  return state->contrast >= kMinContrast && state->white < kMaxWhite &&
         (pose.rotation * Eigen::Vector3d::UnitZ()).dot(pose.translation) < 0;
}

std::optional<SmallPatternFitter::Fit> SmallPatternFitter::Refine(
    const cv::Mat& image, const RigidTransform& initial, Light light, int iterations,
    SmallPatternWorkspace* workspace, const std::optional<NormalPrior>& prior) const {
  if (!Gather(image, initial, kEnoughToFit, workspace)) return std::nullopt;
  State state;
  state.pose = initial;
  Predict(state, workspace);
  MeasureLevels(*workspace, &state);
  if (state.contrast < kMinContrast) return std::nullopt;
  if (light == Light::kShadowEdge && !EvenOut(workspace, &state)) return std::nullopt;
  // The first steps come from far away: then nothing is an outlier.
  double limit = kMaxWhite;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const System system = Linearize(state, limit, workspace);
    if (iteration == kLateStart && system.correlation() < kMinLateCorrelation) return std::nullopt;
    if (!Improve(system, prior, &state)) return std::nullopt;
    if (2 * iteration >= iterations) {
      limit = kOutlier * std::max(system.robust_scale, kLeastNoise * state.contrast);
    }
  }
  System system = Linearize(state, limit, workspace);
  if (prior) prior->AddTo(state.pose.rotation, system.EffectiveVariance(), &system.h, &system.b);
  const Eigen::Matrix<double, kUnknowns, kUnknowns> covariance =
      system.EffectiveVariance() *
      system.h.ldlt().solve(Eigen::Matrix<double, kUnknowns, kUnknowns>::Identity());
  if (!covariance.allFinite()) return std::nullopt;
  Fit fit;
  fit.location.camera_from_pattern = state.pose;
  fit.location.covariance = covariance.topLeftCorner<6, 6>();
  fit.inside_residual = system.InsideRms() / state.contrast;
  fit.ring_residual = system.ring.Rms() / state.contrast;
  fit.white_residual = system.white.Rms() / state.contrast;
  fit.correlation = system.correlation();
  fit.explained = system.explained();
  fit.match.contrast = state.contrast;
  MeasureParts(*workspace, state, &fit.match);
  Predict(state, workspace);
  fit.others = MeasureOthers(image, state, workspace);
  return fit;
}

// Fits an amplitude to the ring's quarters, to each half arm and to the white of each quadrant, on
// top of white that may change evenly over the print, and compares them with the print's contrast.
void SmallPatternFitter::MeasureParts(const SmallPatternWorkspace& workspace, const State& state,
                                      PatternMatch* match) const {
  constexpr int kParts = 15;  // 4 of the ring, 4 half arms, 4 quadrants, white and its slopes
  using Vector = Eigen::Matrix<double, kParts, 1>;
  using Matrix = Eigen::Matrix<double, kParts, kParts>;
  Matrix h = Matrix::Zero();
  Vector b = Vector::Zero();
  std::array<int, 4> highlight{}, inside{};  // pixels of each quarter
  const PlaneMap map(state.pose);
  const double inner = pattern_.inner_radius_m();
  for (const auto& pixel : workspace.pixels) {
    const PlanePoint point = Intersect(map, pixel);
    const Darkness dark = Evaluate(point.x, point.y, point.by_pixel, state.blur_px);
    const double along_x = std::abs(point.x) > std::abs(point.y) ? 1 : 0;
    const int quarter = along_x > 0 ? (point.x > 0 ? 0 : 2) : (point.y > 0 ? 1 : 3);
    const int quadrant = QuadrantOf(point);
    const double radius = point.radius();
    Vector basis = Vector::Zero();
    basis(quarter) = dark.ring;
    basis(4 + quarter) = std::max(dark.arms[0], dark.arms[1]) * (1 - dark.ring);
    if (radius < inner) basis(8 + quadrant) = 1 - dark.value;
    basis(12) = 1;
    basis(13) = point.x;
    basis(14) = point.y;
    h.selfadjointView<Eigen::Lower>().rankUpdate(basis);
    if (radius < inner) {
      ++inside[quarter];
      highlight[quarter] += state.IsHighlight(point, pixel.gray);
    }
    // Cut off where the print should be darker than that: it is as good as white.
    const double expected = state.Gray(point, dark.value);
    const bool missing = pixel.gray >= kSaturated && expected <= pixel.gray;
    b += basis * (missing ? std::max(state.white, pixel.gray) : SeenGray(pixel.gray, expected));
  }
  // Parts that the image does not show get no amplitude instead of a wild one.
  const Vector weight = h.diagonal();
  for (int i = 0; i < kParts; ++i) h(i, i) += 1e-3 + 0.002 * h(i, i);
  const Vector amplitude = h.selfadjointView<Eigen::Lower>().ldlt().solve(b);
  const auto share = [&](double value) { return std::clamp(value / match->contrast, 0.0, 1.0); };
  // A part of which the image shows less than a third of what it shows of its like is not seen.
  const auto seen = [&](int first, int k) {
    return 3 * weight(first + k) >= weight.segment<4>(first).maxCoeff();
  };
  // Nor is an arm in a highlight: one that is missing is white, not brighter than that.
  const auto arm_seen = [&](int k) {
    return seen(4, k) && highlight[k] <= kMaxHighlight * inside[k];
  };
  int parts_seen = 0;
  for (int k = 0; k < 4; ++k) {
    const int before = (k + 3) % 4;
    match->ring[k] = seen(0, k) ? share(-amplitude(k)) : -1;
    match->arm[k] = arm_seen(k) ? share(-amplitude(4 + k)) : -1;
    // Quarter k has half of quadrant k and half of the one before.
    match->quadrant[k] = seen(8, k) && seen(8, before)
                             ? 1 - 0.5 * (share(-amplitude(8 + k)) + share(-amplitude(8 + before)))
                             : -1;
    parts_seen += seen(0, k) + arm_seen(k) + seen(8, k);
  }
  match->seen = parts_seen / 12.0;
}

}  // namespace kestrel
