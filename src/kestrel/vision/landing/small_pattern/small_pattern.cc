// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/small_pattern/small_pattern.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/vision/landing/alignment/column_products.h"
#include "kestrel/vision/landing/image_properties.h"
#include "kestrel/vision/landing/location/neighbor_correlation.h"
#include "kestrel/vision/landing/print_places.h"
#include "kestrel/vision/landing/small_pattern/small_pattern_kernel.h"
#include "kestrel/vision/landing/small_pattern/small_pattern_model.h"

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

// Normal equations of a state for small changes of pose (translation, then rotation about the
// centre), logarithm of the blur, white, contrast and slopes; and sums over the pixels.
struct SmallPatternFitter::System {
  Eigen::Matrix<double, kUnknowns, kUnknowns> h;
  Eigen::Matrix<double, kUnknowns, 1> b;
  double count;  // weighted number of pixels
  double sum;    // sum of the gray values without highlights
  double sum_squares;
  double squares;  // sum of the squared residuals without highlights

  double variance() const { return squares / std::max(1.0, count - kUnknowns); }
  // Share of the image's variance, without its noise, that the print does not explain.
  double unexplained(double noise_variance) const {
    const double noise = noise_variance * count;
    const double about_mean = sum_squares - sum * sum / count - noise;
    return std::clamp((squares - noise) / std::max(about_mean, std::numeric_limits<double>::min()),
                      0.0, 1.0);
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
  const int enough = light == Light::kShadows ? 2 * kEnoughPixels : kEnoughPixels;
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
  fit.location.camera_from_target = state.pose;
  fit.location.covariance = covariance.topLeftCorner<kPoseUnknowns, kPoseUnknowns>();
  fit.location.gray_rms = std::sqrt(system.squares / system.count);
  state.noise_variance = NoiseVariance(workspace);
  const Zones zones(pattern_, *workspace, limit, state.noise_variance);
  fit.inside_residual = zones.InsideRms() / state.contrast;
  fit.ring_residual = zones.ring.Rms() / state.contrast;
  fit.correlation = system.correlation(state.noise_variance);
  fit.explained = system.explained(state.noise_variance);
  fit.shares = MeasureParts(*workspace, state);
  fit.frame_corners = FrameCorners(*workspace, state);
  fit.cross_correlation = CrossCorrelation(*workspace, state);
  return fit;
}

}  // namespace kestrel
