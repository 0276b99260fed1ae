// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens/lens_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include "kestrel/calibration/lens/lens_projection.h"
#include "kestrel/core/base/held_parameters.h"
#include "kestrel/core/base/robust_statistics.h"

namespace kestrel {
namespace {

// Parameters of a view: rotation vector relative to its initial pose (in the camera's frame),
// translation, spread of the black over the white.
constexpr int kViewParameters = 7;
constexpr int kSpread = 6;
constexpr double kSpreadSigmaPx = 0.3;
constexpr double kHuber = 2;  // standard deviations of an edge
// Priors: of the focal length, relative to its initial value, and of the principal point about the
// middle of the image, in widths of the image.
constexpr double kFocalSigma = 0.7;
constexpr double kPrincipalSigma = 0.03;

using LensVector = Eigen::Vector<double, kLensParameters>;
using LensMatrix = Eigen::Matrix<double, kLensParameters, kLensParameters>;
using ViewVector = Eigen::Vector<double, kViewParameters>;

// Distance of an edge from the outline, across it, in standard deviations of the edge.
struct EdgeError {
  template <class T>
  bool operator()(const T* lens, const T* view, T* residual) const {
    const Eigen::Vector3d turned =
        start.rotation * Eigen::Vector3d(edge.on_print.x(), edge.on_print.y(), 0);
    const T on_print[3] = {T(turned.x()), T(turned.y()), T(turned.z())};
    T point[3], pixel[2];
    ceres::AngleAxisRotatePoint(view, on_print, point);
    for (int i = 0; i < 3; ++i) point[i] += view[3 + i];
    if (!ProjectThroughLens(model, lens, point, pixel)) return false;
    residual[0] = (edge.across.x() * (edge.pixel.x() - pixel[0]) +
                   edge.across.y() * (edge.pixel.y() - pixel[1]) - view[kSpread]) /
                  sigma_px;
    return true;
  }

  DistortionModel model;
  const LensEdge& edge;
  const RigidTransform& start;
  double sigma_px;
};

// Prior for a parameter of a block.
template <int kSize>
struct Prior {
  template <class T>
  bool operator()(const T* block, T* residual) const {
    residual[0] = (block[parameter] - value) / sigma;
    return true;
  }
  static ceres::CostFunction* Make(int parameter, double value, double sigma) {
    return new ceres::AutoDiffCostFunction<Prior, 1, kSize>(new Prior{parameter, value, sigma});
  }

  int parameter;
  double value;
  double sigma;
};

LensVector ParametersOf(const CameraIntrinsics& camera) {
  LensVector parameters = LensVector::Zero();
  parameters.head<kDistortion>() << camera.fx_px, camera.fy_px / camera.fx_px, camera.cx_px,
      camera.cy_px;
  for (std::size_t i = 0; i < camera.distortion.size() && kDistortion + i < kLensParameters; ++i) {
    parameters(static_cast<Eigen::Index>(kDistortion + i)) = camera.distortion[i];
  }
  return parameters;
}

// 'like': a camera of the same size and distortion model.
CameraIntrinsics IntrinsicsOf(const LensVector& parameters, const CameraIntrinsics& like) {
  CameraIntrinsics camera = like;
  camera.fx_px = parameters(kFocal);
  camera.fy_px = parameters(kFocal) * parameters(kAspect);
  camera.cx_px = parameters(kPrincipalX);
  camera.cy_px = parameters(kPrincipalY);
  for (std::size_t i = 0; i < camera.distortion.size(); ++i) {
    camera.distortion[i] = parameters(static_cast<Eigen::Index>(kDistortion + i));
  }
  return camera;
}

std::vector<int> FixedParameters(const LensFreedom& freedom) {
  std::vector<int> fixed;
  for (int i = 0; i < kLensParameters; ++i) {
    if (!freedom.IsFree(i)) fixed.push_back(i);
  }
  return fixed;
}

// Variance of the sum of the views' gradients (columns), as fitted. Gradients that follow each
// other may be correlated (Newey and West 1987).
Eigen::MatrixXd ScatterOf(const Eigen::MatrixXd& gradients) {
  constexpr Eigen::Index kLagShare = 12;  // views per view that may still be correlated with it
  const Eigen::Index count = gradients.cols();
  const Eigen::Index lags = count / kLagShare;
  Eigen::MatrixXd scatter = gradients * gradients.transpose();
  for (Eigen::Index lag = 1; lag <= lags; ++lag) {
    const Eigen::MatrixXd across =
        gradients.leftCols(count - lag) * gradients.rightCols(count - lag).transpose();
    const double weight = 1 - static_cast<double>(lag) / static_cast<double>(lags + 1);
    scatter += weight * (across + across.transpose());
  }
  const double freedom = std::max<Eigen::Index>(1, count - gradients.rows());
  return static_cast<double>(count) / freedom * scatter;
}

// Lens and views as one Ceres problem.
class Adjustment {
 public:
  Adjustment(std::span<const LensView> views, const CameraIntrinsics& start,
             const LensFreedom& freedom, double edge_sigma_px)
      : views_(views),
        freedom_(freedom),
        edge_sigma_px_(edge_sigma_px),
        start_(start),
        lens_(ParametersOf(start)),
        states_(views.size()),
        view_blocks_(views.size()) {
    problem_.AddParameterBlock(lens_.data(), kLensParameters);
    ordering_ = std::make_shared<ceres::ParameterBlockOrdering>();
    ordering_->AddElementToGroup(lens_.data(), 1);
    for (std::size_t i = 0; i < views.size(); ++i) AddView(i);
    AddPriors();
    const std::vector<int> fixed = FixedParameters(freedom);
    if (fixed.size() == kLensParameters) {
      problem_.SetParameterBlockConstant(lens_.data());
    } else if (!fixed.empty()) {
      HoldParameters(&problem_, lens_.data(), kLensParameters, fixed);
    }
  }

  // Returns false when the lens cannot show the views.
  bool Solve() {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.linear_solver_ordering = ordering_;
    options.logging_type = ceres::SILENT;
    options.max_num_iterations = 60;
    options.function_tolerance = 1e-7;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    cost_ = summary.final_cost;
    return summary.IsSolutionUsable();
  }

  LensFit Describe() {
    LensFit fit{IntrinsicsOf(lens_, start_), freedom_, LensVector::Zero(), {}, {}, cost_};
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const ViewVector& state = states_[i];
      fit.camera_from_target.push_back(
          {(RotationBy(state.head<3>()) * views_[i].camera_from_target.rotation).normalized(),
           state.segment<3>(3)});
      fit.residuals_px.push_back(ResidualsOf(i));
    }
    if (freedom_.count() > 0) Judge(&fit);
    return fit;
  }

 private:
  void AddView(std::size_t index) {
    const LensView& view = views_[index];
    ViewVector& state = states_[index];
    state << Eigen::Vector3d::Zero(), view.camera_from_target.translation, 0;
    for (const LensEdge& edge : view.edges) {
      using Cost = ceres::AutoDiffCostFunction<EdgeError, 1, kLensParameters, kViewParameters>;
      view_blocks_[index].push_back(problem_.AddResidualBlock(
          new Cost(new EdgeError{start_.distortion_model, edge, view.camera_from_target,
                                 edge_sigma_px_}),
          new ceres::HuberLoss(kHuber), lens_.data(), state.data()));
    }
    view_blocks_[index].push_back(problem_.AddResidualBlock(
        Prior<kViewParameters>::Make(kSpread, 0, kSpreadSigmaPx), nullptr, state.data()));
    ordering_->AddElementToGroup(state.data(), 0);
  }

  void AddPriors() {
    const auto hold = [&](int parameter, double value, double sigma) {
      if (!freedom_.IsFree(parameter)) return;
      lens_blocks_.push_back(problem_.AddResidualBlock(
          Prior<kLensParameters>::Make(parameter, value, sigma), nullptr, lens_.data()));
    };
    hold(kFocal, start_.fx_px, kFocalSigma * start_.fx_px);
    const double principal_sigma_px = kPrincipalSigma * start_.width_px;
    hold(kPrincipalX, 0.5 * (start_.width_px - 1), principal_sigma_px);
    hold(kPrincipalY, 0.5 * (start_.height_px - 1), principal_sigma_px);
  }

  std::vector<double> ResidualsOf(std::size_t index) const {
    const LensView& view = views_[index];
    std::vector<double> residuals;
    for (const LensEdge& edge : view.edges) {
      double residual = 0;
      EdgeError{start_.distortion_model, edge, view.camera_from_target, 1}(
          lens_.data(), states_[index].data(), &residual);
      residuals.push_back(residual);
    }
    return residuals;
  }

  // Rows of the Jacobian and residuals of one view; those of the lens's priors when 'view' is null.
  struct Linearized {
    Eigen::MatrixXd of_lens, of_view;
    Eigen::VectorXd residuals;
  };
  Linearized Linearize(const std::vector<ceres::ResidualBlockId>& blocks, ViewVector* view) {
    ceres::Problem::EvaluateOptions options;
    options.parameter_blocks = {lens_.data()};
    if (view != nullptr) options.parameter_blocks.push_back(view->data());
    options.residual_blocks = blocks;
    ceres::CRSMatrix sparse;
    std::vector<double> residuals;
    problem_.Evaluate(options, nullptr, &residuals, nullptr, &sparse);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
    for (int row = 0; row < sparse.num_rows; ++row) {
      for (int i = sparse.rows[row]; i < sparse.rows[row + 1]; ++i) {
        dense(row, sparse.cols[i]) = sparse.values[i];
      }
    }
    const int lens_columns = freedom_.count();
    return {dense.leftCols(lens_columns), dense.rightCols(dense.cols() - lens_columns),
            Eigen::Map<Eigen::VectorXd>(residuals.data(), std::ssize(residuals))};
  }

  // Computes standard deviations and optimism. With the poses eliminated, each view has a Hessian
  // and a gradient of the lens. For independent residuals the variance of the gradients would be
  // the Hessian; it is larger where whole views are off (the sandwich estimator of Huber and
  // White).
  void Judge(LensFit* fit) {
    const int count = freedom_.count();
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(count, count);
    Eigen::MatrixXd gradients(count, states_.size());
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const Linearized view = Linearize(view_blocks_[i], &states_[i]);
      const Eigen::MatrixXd across = view.of_view.transpose() * view.of_lens;
      const Eigen::LDLT<Eigen::MatrixXd> of_view(
          Eigen::MatrixXd(view.of_view.transpose() * view.of_view));
      const Eigen::MatrixXd elimination = of_view.solve(across);
      hessian += view.of_lens.transpose() * view.of_lens - across.transpose() * elimination;
      gradients.col(static_cast<Eigen::Index>(i)) =
          (view.of_lens - view.of_view * elimination).transpose() * view.residuals;
    }
    const Linearized priors = Linearize(lens_blocks_, nullptr);
    hessian += priors.of_lens.transpose() * priors.of_lens;
    const Eigen::MatrixXd scatter = ScatterOf(gradients);
    const Eigen::MatrixXd inverse = hessian.ldlt().solve(Eigen::MatrixXd::Identity(count, count));
    const Eigen::MatrixXd covariance = inverse * scatter * inverse;
    fit->optimism = (inverse * scatter).trace();
    for (int i = 0, column = 0; i < kLensParameters; ++i) {
      if (!freedom_.IsFree(i)) continue;
      fit->sigmas(i) = std::sqrt(std::max(covariance(column, column), inverse(column, column)));
      ++column;
    }
  }

  std::span<const LensView> views_;
  LensFreedom freedom_;
  double edge_sigma_px_;
  CameraIntrinsics start_;
  LensVector lens_;
  std::vector<ViewVector> states_;
  ceres::Problem problem_;
  std::vector<std::vector<ceres::ResidualBlockId>> view_blocks_;
  std::vector<ceres::ResidualBlockId> lens_blocks_;  // residual blocks of the priors
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_;
  double cost_ = 0;
};

}  // namespace

bool LensFreedom::IsFree(int parameter) const {
  switch (parameter) {
    case kFocal:
      return focal;
    case kAspect:
      return aspect;
    case kPrincipalX:
    case kPrincipalY:
      return principal;
    default:
      return parameter < kDistortion + distortion;
  }
}

int LensFreedom::count() const { return focal + aspect + 2 * principal + distortion; }

double LensFit::RootMeanSquare() const {
  double squares = 0;
  std::size_t count = 0;
  for (const std::vector<double>& view : residuals_px) {
    for (const double residual : view) squares += residual * residual;
    count += view.size();
  }
  return std::sqrt(squares / std::max<std::size_t>(count, 1));
}

CameraIntrinsics LensFit::Simplified() const {
  constexpr int kRadialTangential = 4;  // fewest coefficients
  CameraIntrinsics camera = intrinsics;
  if (camera.distortion_model == DistortionModel::kEquidistant) return camera;
  if (freedom.distortion == 0) {
    camera.distortion_model = DistortionModel::kNone;
    camera.distortion.clear();
  } else if (freedom.distortion <= kRadialTangential) {
    camera.distortion.resize(kRadialTangential);
  }
  return camera;
}

std::optional<LensFit> FitLens(std::span<const LensView> views, const CameraIntrinsics& start,
                               const LensFreedom& freedom, double edge_sigma_px) {
  Adjustment adjustment(views, start, freedom, edge_sigma_px);
  if (!adjustment.Solve()) return std::nullopt;
  return adjustment.Describe();
}

double RobustSigma(const std::vector<std::vector<double>>& residuals_px) {
  std::vector<double> magnitudes;
  for (const std::vector<double>& view : residuals_px) {
    for (const double residual : view) magnitudes.push_back(std::abs(residual));
  }
  return RobustSigmaInPlace(magnitudes);
}

}  // namespace kestrel
