// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/alignment/small_pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/vision/landing/alignment/column_products.h"
#include "kestrel/vision/landing/alignment/small_pattern_kernel.h"
#include "kestrel/vision/landing/alignment/small_pattern_model.h"
#include "kestrel/vision/landing/image_properties.h"
#include "kestrel/vision/landing/location/neighbor_correlation.h"
#include "kestrel/vision/landing/print_places.h"

namespace kestrel {
namespace {

constexpr double kMaxWhite = 600;  // gray value of white under the strongest overexposure
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
// Weights that hold an unknown near to where it is: of the pose a share of its own, of the light
// per pixel. They matter only where the image leaves it open.
constexpr double kPoseDamping = 1e-3;
constexpr double kWhiteWeight = 0.01;
constexpr double kSlopeWeight = 1e-6;
// A step beyond these is wrong: rad, share of the distance. That of the blur's logarithm is cut.
constexpr double kMaxTurn = 0.8;
constexpr double kMaxShift = 0.5;
constexpr double kMaxBlurStep = 0.5;

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
  extent_m_ =
      pattern.outer_radius_m() + std::min(pattern.ring_width_m, PrintPlaces::kMargin * margin);
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

// The box of the disc under a pose; nothing where it is not in view, or too large to be small.
std::optional<SmallPatternFitter::PixelBox> SmallPatternFitter::BoxAround(
    const RigidTransform& pose, const cv::Size& image) const {
  constexpr int kCorners = 8;                  // of an octagon around the circle
  constexpr double kCornerRadius = 1.0823922;  // of the circle's radius
  constexpr int kMinSide = 4;
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  for (int i = 0; i < kCorners; ++i) {
    const double angle = i * (2 * std::numbers::pi / kCorners);
    const double reach = extent_m_ * kCornerRadius;
    Eigen::Vector2d pixel;
    if (camera_.Project(pose.translation + reach * (std::cos(angle) * rotation.col(0) +
                                                    std::sin(angle) * rotation.col(1)),
                        &pixel) == ProjectionStatus::kOutsideModel) {
      return std::nullopt;
    }
    low = low.cwiseMin(pixel);
    high = high.cwiseMax(pixel);
  }
  const PixelBox box{std::max(0, static_cast<int>(std::floor(low.x()))),
                     std::max(0, static_cast<int>(std::floor(low.y()))),
                     std::min(image.width - 1, static_cast<int>(std::ceil(high.x()))),
                     std::min(image.height - 1, static_cast<int>(std::ceil(high.y())))};
  const auto [shorter, longer] = std::minmax({box.right - box.left, box.bottom - box.top});
  if (shorter < kMinSide || longer > kMaxSide) return std::nullopt;
  return box;
}

// Collects the pixels that show the disc of the print and the white around it under 'pose'. Where
// their box has more than 'enough_pixels', takes only every second, third, ... pixel of every such
// row.
bool SmallPatternFitter::Gather(const cv::Mat& image, const RigidTransform& pose, int enough_pixels,
                                SmallPatternWorkspace* workspace) const {
  workspace->count = 0;
  const std::optional<PixelBox> box = BoxAround(pose, image.size());
  if (!box) return false;
  const int width = box->right - box->left, height = box->bottom - box->top;
  const int stride =
      1 + static_cast<int>(std::sqrt(width * height / static_cast<double>(enough_pixels)));
  SmallPatternWorkspace::Patch& patch = workspace->patch;
  patch.left = box->left;
  patch.top = box->top;
  patch.stride = stride;
  patch.width = width / stride + 1;
  patch.height = height / stride + 1;
  for (int y = box->top; y <= box->bottom; y += stride) {
    for (int x = box->left; x <= box->right; x += stride) {
      workspace->u[workspace->count] = static_cast<float>(x);
      workspace->v[workspace->count++] = static_cast<float>(y);
    }
  }
  FindRays(workspace, &workspace->pixels.ray);
  KeepPixelsOfPrint(image, pose, workspace);
  DifferentiateRays(workspace);
  return workspace->count >= kMinPixels;
}

void SmallPatternFitter::FindRays(SmallPatternWorkspace* workspace,
                                  std::array<SmallPatternWorkspace::Column, 3>* columns) const {
  rays_.Rays(workspace->u.data(), workspace->v.data(), workspace->count, (*columns)[0].data(),
             (*columns)[1].data(), (*columns)[2].data());
}

// Keeps the pixels whose rays meet the disc.
void SmallPatternFitter::KeepPixelsOfPrint(const cv::Mat& image, const RigidTransform& pose,
                                           SmallPatternWorkspace* workspace) const {
  SmallPatternWorkspace::Pixels& pixels = workspace->pixels;
  const Eigen::Matrix3f plane_from_ray = PlaneFromRay(pose).cast<float>();
  const auto extent = static_cast<float>(extent_m_ * extent_m_);
  const std::size_t in_box = workspace->count;
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
}

// One-sided differences suffice: they only say how far the blur reaches.
void SmallPatternFitter::DifferentiateRays(SmallPatternWorkspace* workspace) const {
  SmallPatternWorkspace::Pixels& pixels = workspace->pixels;
  const std::size_t count = workspace->count;
  const auto differences = [&](SmallPatternWorkspace::Column* place,
                               std::array<SmallPatternWorkspace::Column, 3>* columns) {
    for (std::size_t i = 0; i < count; ++i) (*place)[i] += 1;
    FindRays(workspace, columns);
    for (std::size_t i = 0; i < count; ++i) (*place)[i] -= 1;
    for (int k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < count; ++i) (*columns)[k][i] -= pixels.ray[k][i];
    }
  };
  differences(&workspace->u, &pixels.ray_by_u);
  differences(&workspace->v, &pixels.ray_by_v);
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

  constexpr int kColumns = SmallPatternWorkspace::kResidual + 1;
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
  const double blur_weight = system.variance() / (LensBlur::kLogSpread * LensBlur::kLogSpread);
  h(kLogBlur, kLogBlur) += blur_weight;
  b(kLogBlur) -= blur_weight * std::log(state->blur_px / LensBlur::kGoodPx);
  h.diagonal().head<kPoseUnknowns>() *= 1 + kPoseDamping;
  if (prior) {
    const double variance = system.variance() * Redundancy(workspace, limit);
    prior->AddTo(state->pose.rotation, variance, &h, &b);
  }
  h(kWhite, kWhite) += kWhiteWeight * system.count;
  for (int i = kSlope; i < kUnknowns; ++i) h(i, i) += kSlopeWeight * system.count;
  const Eigen::Matrix<double, kUnknowns, 1> step = h.ldlt().solve(b);
  if (!step.allFinite()) return false;
  RigidTransform& pose = state->pose;
  const Eigen::Vector3d shift = step.segment<3>(kPoseTranslation);
  const Eigen::Vector3d turn = step.segment<3>(kPoseRotation);
  if (turn.norm() > kMaxTurn || shift.norm() > kMaxShift * pose.translation.norm()) return false;
  pose = Moved(pose, shift, turn);
  state->blur_px =
      std::clamp(state->blur_px * std::exp(std::clamp(step(kLogBlur), -kMaxBlurStep, kMaxBlurStep)),
                 LensBlur::kLeastPx, LensBlur::kMostPx);
  state->white += step(kWhite);
  state->contrast += step(kContrast);
  state->slope += step.segment<2>(kSlope);
  return state->contrast >= GrayContrast::kLeast && state->white < kMaxWhite &&
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
  if (state.contrast < GrayContrast::kLeast) return std::nullopt;
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
  fit.location.covariance = covariance.topLeftCorner<kPoseUnknowns, kPoseUnknowns>();
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

// Sums over the pixels for the parts of a print: 4 quarters of the ring, 4 half arms, 4 quadrants,
// then white and its slopes.
struct SmallPatternFitter::Parts {
  static constexpr int kRing = 0;
  static constexpr int kArm = 4;
  static constexpr int kQuadrant = 8;
  static constexpr int kLight = 12;
  static constexpr int kParts = 15;
  // Number of parts with a share in one pixel: a ring, an arm, a quadrant, three of the light.
  static constexpr std::size_t kOfPixel = 6;
  using Vector = Eigen::Matrix<double, kParts, 1>;
  using Matrix = Eigen::Matrix<double, kParts, kParts>;

  // 'seen': gray value. 'pixel_area': m^2.
  void Add(const std::array<int, kOfPixel>& part, const std::array<double, kOfPixel>& share,
           double seen, double pixel_area) {
    for (std::size_t k = 0; k < 3; ++k) area[part[k]] += share[k] * pixel_area;
    for (std::size_t row = 0; row < part.size(); ++row) {
      b(part[row]) += share[row] * seen;
      for (std::size_t column = 0; column <= row; ++column) {
        h(part[row], part[column]) += share[row] * share[column];
      }
    }
  }

  // Regularization: a part out of view gets no amplitude instead of a wild one.
  Vector Amplitudes() {
    for (int i = 0; i < kParts; ++i) h(i, i) += 1e-3 + 0.002 * h(i, i);
    return h.selfadjointView<Eigen::Lower>().ldlt().solve(b);
  }

  // A part with less than a third of the area in view of the best-seen one of its kind is not
  // judged.
  bool IsSeen(int kind, int k) const {
    return 3 * area[kind + k] >= *std::max_element(&area[kind], &area[kind] + 4);
  }
  // Nor is an arm in a highlight: a missing arm is white, and not brighter than that.
  bool IsArmSeen(int k) const {
    return IsSeen(kArm, k) && highlight[k] <= kMaxHighlight * inside[k];
  }

  Matrix h = Matrix::Zero();
  Vector b = Vector::Zero();
  std::array<int, 4> highlight{}, inside{};  // pixels per quarter
  std::array<double, kLight> area{};         // area of the print's parts in view, m^2
};

SmallPatternFitter::Parts SmallPatternFitter::SumParts(const SmallPatternWorkspace& workspace,
                                                       const State& state) const {
  Parts parts;
  const double inner = pattern_.inner_radius_m();
  const SmallPatternWorkspace::Points& points = workspace.points;
  for (std::size_t i = 0; i < workspace.count; ++i) {
    const double x = points.x[i], y = points.y[i], ring = points.ring[i];
    const double gray = workspace.pixels.gray[i], expected = points.expected[i];
    const int quarter = std::abs(x) > std::abs(y) ? (x > 0 ? 0 : 2) : (y > 0 ? 1 : 3);
    const bool is_inside = x * x + y * y < inner * inner;
    if (is_inside) {
      ++parts.inside[quarter];
      parts.highlight[quarter] += gray > state.White(x, y) + state.Highlight();
    }
    // A saturated pixel where the print should be darker is taken for white.
    const double seen = gray < kSaturatedGray ? gray
                        : expected <= gray    ? std::max(state.white, gray)
                                              : expected;
    const double arm = std::max(points.arm_x[i], points.arm_y[i]) * (1 - ring);
    const double white = is_inside ? 1 - points.dark[i] : 0.0;
    const double pixel_area = std::abs(points.x_by_u[i] * points.y_by_v[i] -  //
                                       points.x_by_v[i] * points.y_by_u[i]);
    parts.Add({Parts::kRing + quarter, Parts::kArm + quarter, Parts::kQuadrant + QuadrantOf(x, y),
               Parts::kLight, Parts::kLight + 1, Parts::kLight + 2},
              {ring, arm, white, 1, x, y}, seen, pixel_area);
  }
  return parts;
}

// Fits amplitudes to the ring's quarters, to each half arm and to the white of each quadrant, on
// top of white that may vary linearly over the print, and compares them with the print's contrast.
void SmallPatternFitter::MeasureParts(const SmallPatternWorkspace& workspace, const State& state,
                                      PatternMatch* match) const {
  constexpr int kRing = Parts::kRing, kArm = Parts::kArm, kQuadrant = Parts::kQuadrant;
  Parts parts = SumParts(workspace, state);
  const Parts::Vector amplitude = parts.Amplitudes();
  const auto share = [&](int part) {
    return std::clamp(-amplitude(part) / match->contrast, 0.0, 1.0);
  };
  int parts_seen = 0;
  for (int k = 0; k < 4; ++k) {
    const int before = (k + 3) % 4;
    const bool is_ring_seen = parts.IsSeen(kRing, k);
    const bool is_arm_seen = parts.IsArmSeen(k);
    const bool is_quadrant_seen = parts.IsSeen(kQuadrant, k);
    match->shares.ring[k] = is_ring_seen ? share(kRing + k) : -1;
    match->shares.arm[k] = is_arm_seen ? share(kArm + k) : -1;
    // Quarter k has half of quadrant k and half of the one before.
    match->shares.quadrant[k] = is_quadrant_seen && parts.IsSeen(kQuadrant, before)
                                    ? 1 - 0.5 * (share(kQuadrant + k) + share(kQuadrant + before))
                                    : -1;
    parts_seen += is_ring_seen + is_arm_seen + is_quadrant_seen;
  }
  match->seen = parts_seen / static_cast<double>(Parts::kLight);
}

}  // namespace kestrel
