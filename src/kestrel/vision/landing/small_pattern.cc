// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/small_pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/vision/landing/column_products.h"
#include "kestrel/vision/landing/neighbor_correlation.h"
#include "kestrel/vision/landing/small_pattern_kernel.h"
#include "kestrel/vision/landing/small_pattern_model.h"

namespace kestrel {
namespace {

constexpr double kMinBlurPx = 0.4;
constexpr double kMaxBlurPx = 1.2;
// Unknowns: pose, blur, white, contrast, and two slopes of the light.
constexpr int kUnknowns = SmallPatternWorkspace::kUnknowns;
constexpr double kBlurSpread = 0.35;  // standard deviation of the blur's logarithm over lenses
constexpr double kMaxWhite = 600;     // gray value of white under the strongest overexposure
// Outliers are residuals beyond kOutlier standard deviations. The standard deviation is at least
// kLeastNoise of the contrast, because no print is perfect.
constexpr double kOutlier = 2.5;
constexpr double kLeastNoise = 0.05;
// A fit that correlates so little after so many steps is given up.
constexpr int kLateStart = 3;
constexpr double kMinLateCorrelation = 0.6;
constexpr double kMaxHighlight = 0.25;  // largest share around a visible arm
constexpr std::size_t kMinPixels = 30;
constexpr int kMaxSide = 256;  // largest side of the box around the print, pixels

// Factor by which the variance of a pixel is larger as the pose sees it: errors that neighbours in
// a row share do not average out along the strokes.
double Redundancy(const SmallPatternWorkspace& workspace, double limit) {
  constexpr double kMaxCorrelation = 0.7;
  NeighborCorrelation neighbors;
  double before = 0;
  for (std::size_t i = 0; i < workspace.count; ++i) {
    const double residual = std::clamp<double>(workspace.points.residual[i], -limit, limit);
    neighbors.Add(before, residual);
    before = residual;
  }
  return neighbors.Redundancy(kMaxCorrelation);
}

// Variance of the image's noise, from the median difference of neighbours' residuals in a row: dirt
// and other figures are wider than a pixel.
double NoiseVariance(SmallPatternWorkspace* workspace) {
  const SmallPatternWorkspace::Points& points = workspace->points;
  std::size_t count = 0;
  const auto stride = static_cast<float>(workspace->patch.stride);
  for (std::size_t i = 1; i < workspace->count; ++i) {
    if (workspace->u[i] - workspace->u[i - 1] != stride) continue;
    const float here = points.seen[i] - points.expected[i];
    const float before = points.seen[i - 1] - points.expected[i - 1];
    workspace->magnitudes[count++] = std::abs(here - before);
  }
  const double difference = RobustSigmaInPlace(std::span(workspace->magnitudes).first(count));
  return 0.5 * difference * difference;
}

// Standard deviation of the residuals from the median of their magnitudes.
double RobustScale(SmallPatternWorkspace* workspace) {
  std::transform(workspace->points.residual.begin(),
                 workspace->points.residual.begin() + static_cast<std::ptrdiff_t>(workspace->count),
                 workspace->magnitudes.begin(), [](float residual) { return std::abs(residual); });
  return RobustSigmaInPlace(std::span(workspace->magnitudes).first(workspace->count));
}

// Residuals by zone of the print, outliers bounded, corrected for noise.
struct Zones {
  Zones(const LandingPattern& pattern, const SmallPatternWorkspace& workspace, double limit,
        double noise_variance) {
    const double inner = pattern.inner_radius_m();
    const double outer = pattern.outer_radius_m() + 0.35 * pattern.ring_width_m;
    const SmallPatternWorkspace::Points& points = workspace.points;
    for (std::size_t i = 0; i < workspace.count; ++i) {
      const double radius = std::hypot(points.x[i], points.y[i]);
      if (radius >= outer) continue;
      Zone& zone = radius < inner ? quadrants[QuadrantOf(points.x[i], points.y[i])] : ring;
      const double residual =
          std::clamp<double>(points.seen[i] - points.expected[i], -limit, limit);
      zone.squares += residual * residual - noise_variance;
      ++zone.count;
    }
  }

  struct Zone {
    double squares = 0;
    int count = 0;
    double Rms() const { return std::sqrt(std::max(0.0, squares / std::max(1, count))); }
  };
  // Returns the RMS of the inside without the worst quadrant, which dirt or a highlight may spoil.
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

  std::array<Zone, 4> quadrants;  // quadrants of the inside of the ring
  Zone ring;
};

}  // namespace

SmallPatternFitter::SmallPatternFitter(const CameraModel& camera, const RayTable& rays,
                                       const LandingPattern& pattern)
    : camera_(camera), rays_(rays), pattern_(pattern) {
  const double margin = 0.5 * pattern.board_size_m - pattern.outer_radius_m();
  extent_m_ = pattern.outer_radius_m() + std::min(1.0 * pattern.ring_width_m, 0.6 * margin);
}

SmallPatternWorkspace::SmallPatternWorkspace() {
  constexpr std::size_t kVector = 64;                                 // at most, floats
  constexpr std::size_t kMost = kEnoughToTellInk + 2 * kMaxSide + 1;  // of a box and its border
  const auto make_room = [](auto&... columns) { (columns.resize(kMost + kVector), ...); };
  for (auto* rays : {&pixels.ray, &pixels.ray_by_u, &pixels.ray_by_v}) {
    for (Column& column : *rays) make_room(column);
  }
  make_room(pixels.gray, u, v, magnitudes, light);
  make_room(patch.gray, patch.print, patch.dilated);
  patch.is_print.resize(kMost);
  make_room(points.x, points.y, points.x_by_u, points.x_by_v, points.y_by_u, points.y_by_v);
  make_room(points.dark, points.ring, points.arm_x, points.arm_y);
  make_room(points.dark_by_x, points.dark_by_y, points.dark_by_log_blur);
  make_room(points.expected, points.seen, points.residual, points.weight, points.root_weight);
  for (Column& column : jacobian) make_room(column);
}

// Collects the pixels that show the disc of the print and the white around it under 'pose'. Where
// their box has more than 'enough_pixels', takes only every second, third, ... pixel of every such
// row.
bool SmallPatternFitter::Gather(const cv::Mat& image, const RigidTransform& pose, int enough_pixels,
                                SmallPatternWorkspace* workspace) const {
  workspace->count = 0;
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  for (int i = 0; i < 8; ++i) {
    const double angle = i * 0.7853981633974483;
    // Corners of an octagon around the circle.
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
  workspace->patch.left = x0;
  workspace->patch.top = y0;
  workspace->patch.stride = stride;
  workspace->patch.width = (x1 - x0) / stride + 1;
  workspace->patch.height = (y1 - y0) / stride + 1;
  SmallPatternWorkspace::Pixels& pixels = workspace->pixels;
  std::size_t in_box = 0;
  for (int y = y0; y <= y1; y += stride) {
    for (int x = x0; x <= x1; x += stride, ++in_box) {
      workspace->u[in_box] = static_cast<float>(x);
      workspace->v[in_box] = static_cast<float>(y);
    }
  }
  const auto rays = [&](std::size_t count, std::array<SmallPatternWorkspace::Column, 3>* columns) {
    rays_.Rays(workspace->u.data(), workspace->v.data(), count, (*columns)[0].data(),
               (*columns)[1].data(), (*columns)[2].data());
  };
  rays(in_box, &pixels.ray);
  // Keeps the pixels whose rays meet the disc.
  const Eigen::Matrix3f plane_from_ray = PlaneFromRay(pose).cast<float>();
  const auto extent = static_cast<float>(extent_m_ * extent_m_);
  std::size_t count = 0;
  for (std::size_t i = 0; i < in_box; ++i) {
    const Eigen::Vector3f ray(pixels.ray[0][i], pixels.ray[1][i], pixels.ray[2][i]);
    const Eigen::Vector3f h = plane_from_ray * ray;
    const int row = static_cast<int>(workspace->v[i]), column = static_cast<int>(workspace->u[i]);
    if (!(h.z() > 0) || h.head<2>().squaredNorm() > extent * h.z() * h.z()) continue;
    for (int k = 0; k < 3; ++k) pixels.ray[k][count] = ray(k);
    pixels.gray[count] = image.ptr(row)[column];
    workspace->u[count] = workspace->u[i];
    workspace->v[count++] = workspace->v[i];
  }
  workspace->count = count;
  // One-sided differences suffice: they only say how far the blur reaches.
  const auto differences = [&](SmallPatternWorkspace::Column* place,
                               std::array<SmallPatternWorkspace::Column, 3>* columns) {
    for (std::size_t i = 0; i < count; ++i) (*place)[i] += 1;
    rays(count, columns);
    for (std::size_t i = 0; i < count; ++i) (*place)[i] -= 1;
    for (int k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < count; ++i) (*columns)[k][i] -= pixels.ray[k][i];
    }
  };
  differences(&workspace->u, &pixels.ray_by_u);
  differences(&workspace->v, &pixels.ray_by_v);
  return count >= kMinPixels;
}

// Normal equations of a state for small changes of pose (translation, then rotation about the
// centre), logarithm of the blur, white, contrast and slopes; and sums over the pixels.
struct SmallPatternFitter::System {
  Eigen::Matrix<double, kUnknowns, kUnknowns> h;
  Eigen::Matrix<double, kUnknowns, 1> b;
  double count;  // weighted number of pixels
  double sum;    // of the gray values, without highlights
  double sum_squares;
  double squares;  // of the residuals, without highlights

  double variance() const { return squares / std::max(1.0, count - kUnknowns); }
  // Share of the image's variance, without its noise, that the print does not explain.
  double unexplained(double noise_variance) const {
    const double noise = noise_variance * count;
    const double about_mean = sum_squares - sum * sum / count - noise;
    return std::clamp((squares - noise) / std::max(about_mean, 1e-9), 0.0, 1.0);
  }
  double correlation(double noise_variance) const {
    return std::sqrt(1 - unexplained(noise_variance));
  }
  // Adjusted R^2. Neighbouring pixels share their blur, so kPixelsPerSample pixels count as one
  // sample.
  double explained(double noise_variance) const {
    constexpr double kPixelsPerSample = 4;
    const double samples = count / kPixelsPerSample;
    return 1 - unexplained(noise_variance) * (samples - 1) / std::max(1.0, samples - 1 - kUnknowns);
  }
};

// Fills the points of the workspace: where each pixel lies on the print and how dark it is there.
void SmallPatternFitter::Predict(const RigidTransform& pose, double blur_px,
                                 SmallPatternWorkspace* workspace) const {
  EvaluatePrint(ModelOf(pattern_, pose, blur_px), workspace);
}

// Fits the gray values of black and white to the predicted print, by linear regression.
void SmallPatternFitter::MeasureLevels(const SmallPatternWorkspace& workspace, State* state) const {
  double n = 0, g = 0, d = 0, dd = 0, gd = 0;
  for (std::size_t i = 0; i < workspace.count; ++i) {
    const double gray = workspace.pixels.gray[i];
    const double dark = workspace.points.dark[i];
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

// Linearizes about a state. Residuals beyond 'limit' (gray values), as by highlights and dirt,
// count less (Huber's function).
SmallPatternFitter::System SmallPatternFitter::Linearize(const State& state, double limit,
                                                         SmallPatternWorkspace* workspace) const {
  Predict(state.pose, state.blur_px, workspace);
  CompareGrays(state.Light(), static_cast<float>(limit), workspace);
  const Eigen::Matrix3f rotation = state.pose.rotation.toRotationMatrix().cast<float>();
  const auto axis = [&rotation](int k) {
    return std::array<float, 3>{rotation(0, k), rotation(1, k), rotation(2, k)};
  };
  Differentiate({axis(0), axis(1), axis(2)}, static_cast<float>(state.contrast), workspace);

  constexpr int kColumns = kUnknowns + 1;  // the last one is the residual
  std::array<const float*, kColumns> columns;
  for (int k = 0; k < kColumns; ++k) columns[k] = workspace->jacobian[k].data();
  Eigen::Matrix<double, kColumns, kColumns> products;
  SumProducts(columns, workspace->count, products.data());
  System system{};
  system.h = products.topLeftCorner<kUnknowns, kUnknowns>();
  system.b = products.topRightCorner<kUnknowns, 1>();
  const SmallPatternWorkspace::Points& points = workspace->points;
  for (std::size_t i = 0; i < workspace->count; ++i) {
    const double weight = points.weight[i];
    const double seen = points.seen[i];
    const double unexplained = seen - points.expected[i];
    system.count += weight;
    system.sum += weight * seen;
    system.sum_squares += weight * seen * seen;
    system.squares += weight * unexplained * unexplained;
  }
  return system;
}

// Makes one Gauss-Newton step; false when the result is invalid.
bool SmallPatternFitter::Improve(const System& system, const std::optional<NormalPrior>& prior,
                                 const SmallPatternWorkspace& workspace, double limit,
                                 State* state) const {
  // Priors keep weakly determined unknowns from taking what others explain: the blur of a lens is
  // roughly known, white is poorly determined where the image saturates, and so is the direction of
  // a small plane.
  Eigen::Matrix<double, kUnknowns, kUnknowns> h = system.h;
  Eigen::Matrix<double, kUnknowns, 1> b = system.b;
  const double blur_weight = system.variance() / (kBlurSpread * kBlurSpread);
  h(6, 6) += blur_weight;
  b(6) -= blur_weight * std::log(state->blur_px / kGoodLensBlurPx);
  for (int i = 0; i < 6; ++i) h(i, i) *= 1.001;
  if (prior) {
    const double variance = system.variance() * Redundancy(workspace, limit);
    prior->AddTo(state->pose.rotation, variance, &h, &b);
  }
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
  const int enough = light == Light::kShadows ? kEnoughToTellInk : kEnoughToFit;
  if (!Gather(image, initial, enough, workspace)) return std::nullopt;
  State state;
  state.pose = initial;
  Predict(state.pose, state.blur_px, workspace);
  MeasureLevels(*workspace, &state);
  if (state.contrast < kMinContrast) return std::nullopt;
  if (light == Light::kShadows && !EvenOut(workspace, &state)) return std::nullopt;
  // The first steps start far away, so nothing counts as an outlier.
  double limit = kMaxWhite;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const System system = Linearize(state, limit, workspace);
    if (iteration == kLateStart && system.correlation(0) < kMinLateCorrelation) return std::nullopt;
    if (!Improve(system, prior, *workspace, limit, &state)) return std::nullopt;
    if (2 * iteration >= iterations) {
      limit = kOutlier * std::max(RobustScale(workspace), kLeastNoise * state.contrast);
    }
  }
  System system = Linearize(state, limit, workspace);
  const double variance = system.variance() * Redundancy(*workspace, limit);
  if (prior) prior->AddTo(state.pose.rotation, variance, &system.h, &system.b);
  const Eigen::Matrix<double, kUnknowns, kUnknowns> covariance =
      variance * system.h.ldlt().solve(Eigen::Matrix<double, kUnknowns, kUnknowns>::Identity());
  if (!covariance.allFinite()) return std::nullopt;
  Fit fit;
  fit.location.camera_from_pattern = state.pose;
  fit.location.covariance = covariance.topLeftCorner<6, 6>();
  fit.location.gray_rms = std::sqrt(system.squares / system.count);
  state.noise_variance = NoiseVariance(workspace);
  const Zones zones(pattern_, *workspace, limit, state.noise_variance);
  fit.inside_residual = zones.InsideRms() / state.contrast;
  fit.ring_residual = zones.ring.Rms() / state.contrast;
  fit.correlation = system.correlation(state.noise_variance);
  fit.explained = system.explained(state.noise_variance);
  fit.match.contrast = state.contrast;
  MeasureParts(*workspace, state, &fit.match);
  fit.frame_corners = FrameCorners(*workspace, state);
  fit.cross_correlation = CrossCorrelation(*workspace, state);
  return fit;
}

// Fits amplitudes to the ring's quarters, to each half arm and to the white of each quadrant, on
// top of white that may vary linearly over the print, and compares them with the print's contrast.
void SmallPatternFitter::MeasureParts(const SmallPatternWorkspace& workspace, const State& state,
                                      PatternMatch* match) const {
  constexpr int kParts = 15;  // 4 of the ring, 4 half arms, 4 quadrants, white and its slopes
  using Vector = Eigen::Matrix<double, kParts, 1>;
  using Matrix = Eigen::Matrix<double, kParts, kParts>;
  Matrix h = Matrix::Zero();
  Vector b = Vector::Zero();
  std::array<int, 4> highlight{}, inside{};  // pixels per quarter
  std::array<double, 12> area{};             // area of the print's parts in view, m^2
  const double inner = pattern_.inner_radius_m();
  const SmallPatternWorkspace::Points& points = workspace.points;
  for (std::size_t i = 0; i < workspace.count; ++i) {
    const double x = points.x[i], y = points.y[i], ring = points.ring[i];
    const double gray = workspace.pixels.gray[i], expected = points.expected[i];
    const int quarter = std::abs(x) > std::abs(y) ? (x > 0 ? 0 : 2) : (y > 0 ? 1 : 3);
    const bool is_inside = x * x + y * y < inner * inner;
    if (is_inside) {
      ++inside[quarter];
      highlight[quarter] += gray > state.White(x, y) + state.Highlight();
    }
    // A saturated pixel where the print should be darker is taken for white.
    const double seen = gray < kSaturatedGray ? gray
                        : expected <= gray    ? std::max(state.white, gray)
                                              : expected;
    // The parts that a pixel belongs to, in their order.
    const std::array<int, 6> part{quarter, 4 + quarter, 8 + QuadrantOf(x, y), 12, 13, 14};
    const std::array<double, 6> share{ring,
                                      std::max(points.arm_x[i], points.arm_y[i]) * (1 - ring),
                                      is_inside ? 1 - points.dark[i] : 0.0,
                                      1,
                                      x,
                                      y};
    const double pixel_area = std::abs(points.x_by_u[i] * points.y_by_v[i] -  //
                                       points.x_by_v[i] * points.y_by_u[i]);
    for (std::size_t k = 0; k < 3; ++k) area[part[k]] += share[k] * pixel_area;
    for (std::size_t row = 0; row < part.size(); ++row) {
      b(part[row]) += share[row] * seen;
      for (std::size_t column = 0; column <= row; ++column) {
        h(part[row], part[column]) += share[row] * share[column];
      }
    }
  }
  // Regularization: a part out of view gets no amplitude instead of a wild one.
  for (int i = 0; i < kParts; ++i) h(i, i) += 1e-3 + 0.002 * h(i, i);
  const Vector amplitude = h.selfadjointView<Eigen::Lower>().ldlt().solve(b);
  const auto share = [&](double value) { return std::clamp(value / match->contrast, 0.0, 1.0); };
  // A part with less than a third of the area in view of the best-seen one of its kind is not
  // judged.
  const auto seen = [&](int first, int k) {
    return 3 * area[first + k] >= *std::max_element(&area[first], &area[first] + 4);
  };
  // Nor is an arm in a highlight: a missing arm is white, and not brighter than that.
  const auto arm_seen = [&](int k) {
    return seen(4, k) && highlight[k] <= kMaxHighlight * inside[k];
  };
  int parts_seen = 0;
  for (int k = 0; k < 4; ++k) {
    const int before = (k + 3) % 4;
    match->shares.ring[k] = seen(0, k) ? share(-amplitude(k)) : -1;
    match->shares.arm[k] = arm_seen(k) ? share(-amplitude(4 + k)) : -1;
    // Quarter k has half of quadrant k and half of the one before.
    match->shares.quadrant[k] =
        seen(8, k) && seen(8, before)
            ? 1 - 0.5 * (share(-amplitude(8 + k)) + share(-amplitude(8 + before)))
            : -1;
    parts_seen += seen(0, k) + arm_seen(k) + seen(8, k);
  }
  match->seen = parts_seen / 12.0;
}

}  // namespace kestrel
