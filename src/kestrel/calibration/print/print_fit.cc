// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/print/print_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include "kestrel/core/base/held_parameters.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/base/robust_statistics.h"

namespace kestrel {
namespace {

// The estimated parameters: rotation vector of the pose relative to its initial value (in the
// camera's frame), translation (m), logarithm of the zoom, bend of the lens, spread of the black
// over the white, dimensions (m).
enum Parameter {
  kTurn = 0,
  kTranslation = 3,
  kZoom = 6,
  kBend,
  kSpread,
  kInnerRadius,
  kArmWidth,
  kArmHalfLength,
  kParameters
};
constexpr double kSpreadSigma_px =
    0.6;  // spread by optics, exposure and gamma: real frames have up to 1.1
constexpr double kEdgeSigma_px = 0.2;  // initial value
constexpr double kLeastSigma_px = 0.05;
constexpr double kUnmodelled_px = 0.15;  // errors by gaps of few pixels and by the lens
constexpr double kMaxZoom = 1.1;         // logarithm: three times as near, or as far, as assumed
constexpr double kHuber = 2;             // standard deviations
// Fewest edges: of 180 on the outer and about 100 on the inner circle, 96 on sides, 28 on ends.
constexpr int kMinCircle = 60, kMinSides = 40, kMinEnds = 14;

// Distance of an edge from its outline, in standard deviations of the edge.
struct LineError {
  template <class T>
  bool operator()(const T* state, T* residual) const {
    using std::exp;
    using std::sqrt;
    const T wide = exp(-state[kZoom]) * (1.0 + state[kBend] * corner_share);
    const T in_camera[3] = {wide * ray.x(), wide * ray.y(), T(ray.z())};
    // The plane's point on the ray: origin + distance * direction, in the pattern's axes.
    const T back[3] = {-state[0], -state[1], -state[2]};
    const T center[3] = {-state[kTranslation], -state[kTranslation + 1], -state[kTranslation + 2]};
    T direction[3], origin[3];
    ToPattern(back, in_camera, direction);
    ToPattern(back, center, origin);
    const T distance = -origin[2] / direction[2];
    if (!(distance > 0.0)) return false;
    const T x = origin[0] + distance * direction[0];
    const T y = origin[1] + distance * direction[1];
    const T radius = sqrt(x * x + y * y);
    const T reach = outwards.x() * x + outwards.y() * y;
    T error(0.0);
    switch (line) {
      case PrintLine::kOuterCircle:
        error = radius - outer_radius;
        break;
      case PrintLine::kInnerCircle:
        error = state[kInnerRadius] - radius;
        break;
      case PrintLine::kArmSide:
        error = reach - 0.5 * state[kArmWidth];
        break;
      case PrintLine::kArmEnd:
        error = reach - state[kArmHalfLength];
        break;
    }
    residual[0] = (error - state[kSpread]) / sigma_m;
    return true;
  }

  template <class T>
  void ToPattern(const T* turn_back, const T* vector, T* turned) const {
    T by_turn[3];
    ceres::AngleAxisRotatePoint(turn_back, vector, by_turn);
    const Eigen::Matrix3d& axes = pattern_from_camera;
    for (int i = 0; i < 3; ++i) {
      turned[i] = axes(i, 0) * by_turn[0] + axes(i, 1) * by_turn[1] + axes(i, 2) * by_turn[2];
    }
  }

  PrintLine line;
  Eigen::Vector2d outwards;
  Eigen::Vector3d ray;
  double corner_share;  // squared distance from the axis, relative to the corner's
  Eigen::Matrix3d pattern_from_camera;
  double outer_radius;
  double sigma_m;
};

struct LinePrior {
  template <class T>
  bool operator()(const T* state, T* residual) const {
    residual[0] = (state[parameter] - value) / sigma;
    return true;
  }
  int parameter;
  double value;
  double sigma;
};

using State = std::array<double, kParameters>;

class LineFit {
 public:
  LineFit(const LensPrior& lens, const FoundPrint& print)
      : lens_(lens), start_(print), camera_(print.camera) {
    state_.fill(0);
    for (int i = 0; i < 3; ++i) state_[kTranslation + i] = pose().translation[i];
    state_[kInnerRadius] = print.pattern.inner_radius_m();
    state_[kArmWidth] = print.pattern.arm_width_m;
    state_[kArmHalfLength] = print.pattern.arm_half_length_m;
    const CameraIntrinsics& camera = print.camera;
    corner_ =
        Eigen::Vector2d(0.5 * camera.width_px / camera.fx_px, 0.5 * camera.height_px / camera.fy_px)
            .squaredNorm();
  }

  void Add(const PrintLineEdge& edge) {
    Eigen::Vector3d ray;
    if (camera_.Unproject(edge.pixel, &ray) == ProjectionStatus::kOutsideModel) return;
    const double off_axis = ray.head<2>().squaredNorm() / ray.squaredNorm();
    errors_.push_back({edge.line, edge.outwards, ray, off_axis / corner_,
                       pose().rotation.toRotationMatrix().transpose(),
                       start_.pattern.outer_radius_m(), kEdgeSigma_px * start_.pixel_m});
  }

  // Solves twice: with the expected scatter, and with the actual one. Returns false when there is
  // no solution. 'with_ends': the length of the arms is visible.
  bool Solve(bool with_ends) {
    for (int round = 0; round < 2; ++round) {
      if (round > 0) {
        const double sigma_m = Scatter();
        for (LineError& error : errors_) error.sigma_m = sigma_m;
      }
      if (!SolveOnce(with_ends)) return false;
    }
    return true;
  }

  PrintFit Describe(bool with_ends) const {
    FoundPrint print = start_;
    const double zoom = std::exp(state_[kZoom]);
    print.camera.fx_px *= zoom;
    print.camera.fy_px *= zoom;
    Eigen::Matrix3d turn;
    ceres::AngleAxisToRotationMatrix(&state_[kTurn], turn.data());
    print.camera_from_target = {(Eigen::Quaterniond(turn) * pose().rotation).normalized(),
                                Eigen::Vector3d(&state_[kTranslation])};
    print.pattern.ring_width_m = print.pattern.outer_radius_m() - state_[kInnerRadius];
    print.pattern.arm_width_m = state_[kArmWidth];
    print.pattern.arm_half_length_m = state_[kArmHalfLength];
    constexpr double kMaxScatter_px = 0.5, kMaxSpread_px = 3 * kSpreadSigma_px;
    const bool is_consistent = ViolationsOf(print.pattern).empty() &&
                               Scatter() <= kMaxScatter_px * start_.pixel_m &&
                               std::abs(state_[kSpread]) <= kMaxSpread_px * start_.pixel_m;
    return {Measured(print, with_ends), print, is_consistent};
  }

 private:
  const RigidTransform& pose() const { return start_.camera_from_target; }

  PrintMeasurement Measured(const FoundPrint& print, bool with_ends) const {
    const auto length = [this](double value, int parameter) {
      return MeasuredLength{value, std::hypot(std::sqrt(covariance_(parameter, parameter)),
                                              kUnmodelled_px * start_.pixel_m)};
    };
    PrintMeasurement measured;
    measured.ring_width = length(print.pattern.ring_width_m, kInnerRadius);
    measured.arm_width = length(print.pattern.arm_width_m, kArmWidth);
    if (with_ends) {
      measured.arm_half_length = length(print.pattern.arm_half_length_m, kArmHalfLength);
    }
    const Eigen::Vector3d& center = print.camera_from_target.translation;
    const Eigen::Vector3d toward = center.normalized();
    const Eigen::Matrix3d spread = covariance_.block<3, 3>(kTranslation, kTranslation);
    measured.distance = {center.norm(), std::sqrt(toward.dot(spread * toward))};
    measured.pixel_m = print.pixel_m;
    measured.ring_px = print.pattern.outer_diameter_m / print.pixel_m;
    return measured;
  }

  bool SolveOnce(bool with_ends) {
    ceres::Problem problem;
    for (const LineError& error : errors_) {
      if (error.line == PrintLine::kArmEnd && !with_ends) continue;
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<LineError, 1, kParameters>(new LineError(error)),
          new ceres::HuberLoss(kHuber), state_.data());
    }
    const auto hold = [&](int parameter, double value, double sigma) {
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<LinePrior, 1, kParameters>(
                                   new LinePrior{parameter, value, sigma}),
                               nullptr, state_.data());
    };
    hold(kZoom, std::log(lens_.focal_px / start_.camera.fx_px), lens_.zoom_sigma);
    // A view straight from above does not determine the zoom, and the search would diverge.
    const double assumed = std::log(lens_.focal_px / start_.camera.fx_px);
    problem.SetParameterLowerBound(state_.data(), kZoom, assumed - kMaxZoom);
    problem.SetParameterUpperBound(state_.data(), kZoom, assumed + kMaxZoom);
    state_[kZoom] = std::clamp(state_[kZoom], assumed - kMaxZoom, assumed + kMaxZoom);
    hold(kBend, 0, lens_.bend_sigma);
    hold(kSpread, 0, kSpreadSigma_px * start_.pixel_m);
    if (!with_ends) HoldParameters(&problem, state_.data(), kParameters, {kArmHalfLength});
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.logging_type = ceres::SILENT;
    options.max_num_iterations = 100;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable()) return false;
    ceres::Covariance::Options how;
    how.algorithm_type = ceres::DENSE_SVD;
    ceres::Covariance covariance(how);
    const double* const block = state_.data();
    return covariance.Compute(std::vector{std::pair(block, block)}, &problem) &&
           covariance.GetCovarianceBlock(block, block, covariance_.data());
  }

  // Standard deviation of the edges from their outlines, estimated by the median, m.
  double Scatter() const {
    std::vector<double> magnitudes;
    for (const LineError& error : errors_) {
      double residual = 0;
      if (error(state_.data(), &residual)) magnitudes.push_back(std::abs(residual * error.sigma_m));
    }
    return std::max(RobustSigmaInPlace(magnitudes), kLeastSigma_px * start_.pixel_m);
  }

  LensPrior lens_;
  FoundPrint start_;
  CameraModel camera_;
  double corner_;  // squared tangent of the angle at the image's corner
  State state_;
  std::vector<LineError> errors_;
  Eigen::Matrix<double, kParameters, kParameters, Eigen::RowMajor> covariance_;
};

}  // namespace

std::optional<PrintFit> FitPrint(std::span<const PrintLineEdge> edges, const LensPrior& lens,
                                 const FoundPrint& print) {
  const auto count = [&edges](PrintLine line) {
    return std::count_if(edges.begin(), edges.end(),
                         [line](const PrintLineEdge& edge) { return edge.line == line; });
  };
  if (count(PrintLine::kOuterCircle) < kMinCircle || count(PrintLine::kInnerCircle) < kMinCircle ||
      count(PrintLine::kArmSide) < kMinSides) {
    return std::nullopt;
  }
  LineFit fit(lens, print);
  for (const PrintLineEdge& edge : edges) fit.Add(edge);
  const bool with_ends = count(PrintLine::kArmEnd) >= kMinEnds;
  if (!fit.Solve(with_ends)) return std::nullopt;
  return fit.Describe(with_ends);
}

}  // namespace kestrel
