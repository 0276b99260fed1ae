// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens/lens_choice.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/geometry/mirror_pose.h"

namespace kestrel {
namespace {

constexpr double kLeastSigmaPx = 0.02;  // least standard deviation of an edge
constexpr double kOutlier = 4;          // limit for an edge, in standard deviations
constexpr double kOutlierView = 3;      // relative to the error of the median view
// Lenses of a pinhole model show nothing farther from their axis, in practice.
constexpr double kMaxPinholeAngle = Radians(80);

// Numbers of coefficients that are tried, in order; the two tangential ones are estimated together.
std::vector<int> DistortionOrders(DistortionModel model) {
  if (model == DistortionModel::kNone) return {0};
  if (model == DistortionModel::kEquidistant) return {0, 1, 2, 3, 4};
  return {0, 1, 2, 4, 5};
}

double LargestRadiusPx(const std::vector<LensView>& views, const CameraIntrinsics& camera) {
  double largest = 0;
  for (const LensView& view : views) {
    for (const LensEdge& edge : view.edges) {
      largest = std::max(largest,
                         std::hypot(edge.pixel.x() - camera.cx_px, edge.pixel.y() - camera.cy_px));
    }
  }
  return largest;
}

// Returns a lens of the distortion model 'model' that is like 'camera' out to 'radius_px' from the
// principal point, with all coefficients of the model, by linear least squares over the radius.
// Returns nothing when that is not possible.
std::optional<CameraIntrinsics> Converted(const CameraIntrinsics& camera, DistortionModel model,
                                          double radius_px) {
  CameraIntrinsics converted = camera;
  converted.distortion_model = model;
  const auto count = static_cast<std::size_t>(DistortionOrders(model).back());
  converted.distortion.resize(count);
  const bool has_more = camera.distortion.size() > count;  // a rational lens
  if (camera.distortion_model == model && !has_more) return converted;
  std::fill(converted.distortion.begin(), converted.distortion.end(), 0.0);
  constexpr int kSamples = 30;
  constexpr int kTerms = 2;
  Eigen::Matrix2d h = 1e-6 * Eigen::Matrix2d::Identity();
  Eigen::Vector2d g = Eigen::Vector2d::Zero();
  const CameraModel lens(camera);
  for (int i = 1; i <= kSamples; ++i) {
    const double radius = radius_px * i / kSamples;
    Eigen::Vector3d ray;
    if (lens.Unproject({camera.cx_px + radius, camera.cy_px}, &ray) ==
        ProjectionStatus::kOutsideModel) {
      break;
    }
    const double theta = std::atan2(ray.head<2>().norm(), ray.z());
    if (model != DistortionModel::kEquidistant && theta > kMaxPinholeAngle) return std::nullopt;
    const double base = model == DistortionModel::kEquidistant ? theta : std::tan(theta);
    const Eigen::Vector2d terms = base * Eigen::Vector2d(base * base, std::pow(base, 4));
    h += terms * terms.transpose();
    g += terms * (radius / camera.fx_px - base);
  }
  const Eigen::Vector2d k = h.ldlt().solve(g);
  for (int i = 0; i < std::min<int>(kTerms, static_cast<int>(converted.distortion.size())); ++i) {
    converted.distortion[i] = k(i);
  }
  return converted;
}

void SetPoses(const std::vector<RigidTransform>& poses, std::vector<LensView>* views) {
  for (std::size_t i = 0; i < views->size(); ++i) (*views)[i].camera_from_target = poses[i];
}

double SumOfMagnitudes(const std::vector<double>& residuals) {
  double sum = 0;
  for (const double residual : residuals) sum += std::abs(residual);
  return sum;
}

// The least score is the best: the cost, and the amount by which the parameters are expected to
// have made it too small, with the factor of Schwarz's criterion (BIC) for this number of edges.
double Score(const LensFit& fit) {
  double edges = 0;
  for (const auto& residuals : fit.residuals_px) edges += static_cast<double>(residuals.size());
  return fit.cost + 0.5 * std::log(edges) * fit.optimism;
}

void Offer(const std::optional<LensFit>& fit, std::optional<LensFit>* best) {
  if (!fit || !fit->Simplified().Validate().empty()) return;
  if (!*best || Score(*fit) < Score(**best)) *best = fit;
}

}  // namespace

std::vector<DistortionModel> LensChoice::Kinds() const {
  if (model_) return {*model_};
  return {DistortionModel::kRadialTangential, DistortionModel::kEquidistant};
}

// Fits the poses of the views to the lens, and takes the better one of two mirror images for each.
bool LensChoice::Resect(const CameraIntrinsics& lens) {
  constexpr LensFreedom kNothing{.focal = false, .aspect = false, .principal = false};
  std::vector<LensView> mirrored = views_;
  for (LensView& view : mirrored) view.camera_from_target = MirrorPose(view.camera_from_target);
  const auto fit = FitLens(views_, lens, kNothing, edge_sigma_px_);
  if (!fit) return false;
  SetPoses(fit->camera_from_target, &views_);
  const auto other = FitLens(mirrored, lens, kNothing, edge_sigma_px_);
  if (!other) return true;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (SumOfMagnitudes(other->residuals_px[i]) < SumOfMagnitudes(fit->residuals_px[i])) {
      views_[i].camera_from_target = other->camera_from_target[i];
    }
  }
  return true;
}

std::optional<CameraIntrinsics> LensChoice::Approach(const CameraIntrinsics& start) {
  const auto lens = Converted(start, start.distortion_model, LargestRadiusPx(views_, start));
  if (!lens || !Resect(*lens)) return std::nullopt;
  std::optional<LensFit> best;
  for (const DistortionModel kind : Kinds()) {
    std::optional<LensFit> fit = FitKind(*lens, kind);
    if (fit && (!best || fit->cost < best->cost)) best = std::move(fit);
  }
  if (!best) return std::nullopt;
  Clean(*best);
  return best->intrinsics;
}

std::optional<LensFit> LensChoice::Choose(const CameraIntrinsics& start) {
  std::optional<LensFit> best;
  for (const DistortionModel kind : Kinds()) Offer(BestOrder(start, kind), &best);
  if (!best) return std::nullopt;
  LensFreedom with_aspect = best->freedom;
  with_aspect.aspect = true;
  Offer(Refit(*best, best->intrinsics, with_aspect), &best);
  // With independent edges the optimism would equal the number of free parameters. A larger one
  // means that edges of a view share errors: each counts less, so its standard deviation is raised
  // and the priors gain weight.
  const double alike = std::max(1.0, best->optimism / best->freedom.count());
  edge_sigma_px_ *= std::sqrt(alike);
  best = Refit(*best, best->intrinsics, best->freedom);
  if (best) SetPoses(best->camera_from_target, &views_);
  return best;
}

// Fit with the best number of coefficients of a distortion model.
std::optional<LensFit> LensChoice::BestOrder(const CameraIntrinsics& start,
                                             DistortionModel kind) const {
  std::optional<LensFit> best;
  std::optional<LensFit> fit = FitKind(start, kind);
  std::vector<int> orders = DistortionOrders(kind);
  for (orders.pop_back(); fit; orders.pop_back()) {
    Offer(fit, &best);
    // The cost cannot fall with fewer coefficients.
    if (orders.empty() || (best && fit->cost > Score(*best))) break;
    fit = FitOrder(*fit, orders.back());
  }
  return best;
}

// Fit with all coefficients of a distortion model.
std::optional<LensFit> LensChoice::FitKind(const CameraIntrinsics& start,
                                           DistortionModel kind) const {
  const auto begin = Converted(start, kind, LargestRadiusPx(views_, start));
  if (!begin) return std::nullopt;
  const int all = DistortionOrders(kind).back();
  const int few = std::min(1, all);
  auto rough = FitLens(views_, *begin, {.distortion = few}, edge_sigma_px_);
  if (!rough || few == all) return rough;
  return FitOrder(*rough, all);
}

// Fit with the first 'order' coefficients; the others are 0.
std::optional<LensFit> LensChoice::FitOrder(const LensFit& fit, int order) const {
  CameraIntrinsics start = fit.intrinsics;
  std::fill(start.distortion.begin() + order, start.distortion.end(), 0.0);
  return Refit(fit, start, {.distortion = order});
}

// Starts from the poses of another fit of these views.
std::optional<LensFit> LensChoice::Refit(const LensFit& fit, const CameraIntrinsics& start,
                                         const LensFreedom& freedom) const {
  std::vector<LensView> views = views_;
  SetPoses(fit.camera_from_target, &views);
  return FitLens(views, start, freedom, edge_sigma_px_);
}

// Removes the edges and views that the fit does not explain, and gives the others its poses.
void LensChoice::Clean(const LensFit& fit) {
  std::vector<double> errors;
  for (const auto& residuals : fit.residuals_px) {
    errors.push_back(SumOfMagnitudes(residuals) / static_cast<double>(residuals.size()));
  }
  std::vector<double> sorted = errors;
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted[sorted.size() / 2];
  edge_sigma_px_ = std::max(kLeastSigmaPx, RobustSigma(fit.residuals_px));
  std::vector<LensView> kept;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (errors[i] > kOutlierView * usual) continue;
    LensView view{views_[i].name, {}, fit.camera_from_target[i]};
    for (std::size_t k = 0; k < views_[i].edges.size(); ++k) {
      if (std::abs(fit.residuals_px[i][k]) > kOutlier * edge_sigma_px_) continue;
      view.edges.push_back(views_[i].edges[k]);
    }
    kept.push_back(std::move(view));
  }
  outliers_ += static_cast<int>(views_.size() - kept.size());
  views_ = std::move(kept);
}

}  // namespace kestrel
