// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "kestrel/base/error.h"

namespace kestrel {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr std::size_t kMinViews = 8;
constexpr std::size_t kMaxViews = 100;
constexpr std::size_t kFewViews = 40;  // enough to find more with
// Standard deviations of the focal length, of itself: what is no calibration, and what is no good
// one.
constexpr double kMaxFocalSigma = 0.05;
constexpr double kGoodFocalSigma = 0.01;
constexpr double kMaxPrincipalSigma = 0.01;  // of the image's width
constexpr double kLeastReach = 0.35;         // of the edges, in halves of the image's diagonal
constexpr double kLevelDeg = 12;             // views with less tilt look straight at the pattern
// Of an edge, px: before it is known, and the least that is believed.
constexpr double kRoughSigmaPx = 0.5;
constexpr double kLeastSigmaPx = 0.02;
constexpr double kOutlier = 4;      // standard deviations, of an edge
constexpr double kOutlierView = 3;  // its error in those of the view in the middle
// Angle from the axis from which on no image of a pinhole kind reaches.
constexpr double kMaxPinholeAngle = 80 / kDegrees;

// How many coefficients are estimated, one after the other; the two tangential ones go together.
std::vector<int> DistortionOrders(DistortionModel model) {
  if (model == DistortionModel::kNone) return {0};
  if (model == DistortionModel::kEquidistant) return {0, 1, 2, 3, 4};
  return {0, 1, 2, 4, 5};
}

std::size_t CoefficientCount(DistortionModel model) {
  return static_cast<std::size_t>(DistortionOrders(model).back());
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

// A lens of kind 'model' that is like 'camera' out to 'radius_px' from the principal point, with
// all coefficients that the kind has: by linear least squares over the radius. Nothing where it
// cannot be.
std::optional<CameraIntrinsics> Converted(const CameraIntrinsics& camera, DistortionModel model,
                                          double radius_px) {
  CameraIntrinsics converted = camera;
  converted.distortion_model = model;
  converted.distortion.resize(CoefficientCount(model));
  if (camera.distortion_model == model) return converted;
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
  for (std::size_t i = 0; i < views->size(); ++i) (*views)[i].camera_from_pattern = poses[i];
}

// The pose under which a far print looks the same: its normal on the other side of the line of
// sight.
RigidTransform Mirrored(const RigidTransform& pose) {
  const Eigen::Vector3d sight = pose.translation.normalized();
  const Eigen::Vector3d normal = pose.rotation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d mirrored = 2 * normal.dot(sight) * sight - normal;
  return {(Eigen::Quaterniond::FromTwoVectors(normal, mirrored) * pose.rotation).normalized(),
          pose.translation};
}

double SumOfMagnitudes(const std::vector<double>& residuals) {
  double sum = 0;
  for (const double residual : residuals) sum += std::abs(residual);
  return sum;
}

// Brings the poses to where the lens has the views, each to the better one of two mirror images.
bool Resect(const CameraIntrinsics& lens, std::vector<LensView>* views) {
  constexpr LensFreedom kNothing{.focal = false, .aspect = false, .principal = false};
  std::vector<LensView> mirrored = *views;
  for (LensView& view : mirrored) view.camera_from_pattern = Mirrored(view.camera_from_pattern);
  const auto fit = FitLens(*views, lens, kNothing, kRoughSigmaPx);
  if (!fit) return false;
  SetPoses(fit->camera_from_pattern, views);
  const auto other = FitLens(mirrored, lens, kNothing, kRoughSigmaPx);
  if (!other) return true;
  for (std::size_t i = 0; i < views->size(); ++i) {
    if (SumOfMagnitudes(other->residuals_px[i]) < SumOfMagnitudes(fit->residuals_px[i])) {
      (*views)[i].camera_from_pattern = other->camera_from_pattern[i];
    }
  }
  return true;
}

// What a fit has to be small in: its cost, and what its parameters are expected to have made it too
// small by, times that of Schwarz's criterion (BIC) for so many edges.
double Score(const LensFit& fit) {
  double edges = 0;
  for (const auto& residuals : fit.residuals_px) edges += static_cast<double>(residuals.size());
  return fit.cost + 0.5 * std::log(edges) * fit.optimism;
}

// A lens that is written and read as what it is.
CameraIntrinsics Simplified(const LensFit& fit) {
  CameraIntrinsics camera = fit.intrinsics;
  if (camera.distortion_model == DistortionModel::kEquidistant) return camera;
  if (fit.freedom.distortion == 0) {
    camera.distortion_model = DistortionModel::kNone;
    camera.distortion.clear();
  } else if (fit.freedom.distortion < 5) {
    camera.distortion.resize(4);
  }
  return camera;
}

bool IsValid(const LensFit& fit) { return Simplified(fit).Validate().empty(); }

// The kinds of lenses that may be.
std::vector<DistortionModel> Kinds(std::optional<DistortionModel> model) {
  if (model) return {*model};
  return {DistortionModel::kRadialTangential, DistortionModel::kEquidistant};
}

// Finds the lens of views that have poses.
class LensChoice {
 public:
  LensChoice(std::vector<LensView> views, std::optional<DistortionModel> model)
      : views_(std::move(views)), model_(model) {}

  // The best of all kinds with all coefficients, from a lens that may be far off.
  std::optional<LensFit> Begin(const CameraIntrinsics& start) const {
    std::optional<LensFit> best;
    for (const DistortionModel kind : Kinds(model_)) {
      std::optional<LensFit> fit = FitKind(start, kind, kRoughSigmaPx);
      if (fit && (!best || fit->cost < best->cost)) best = std::move(fit);
    }
    return best;
  }

  // The best of all kinds, numbers of coefficients and aspects, from a lens that is near.
  std::optional<LensFit> Choose(const CameraIntrinsics& start, double edge_sigma_px) const {
    std::optional<LensFit> best;
    for (const DistortionModel kind : Kinds(model_)) {
      std::optional<LensFit> fit = FitKind(start, kind, edge_sigma_px);
      std::vector<int> orders = DistortionOrders(kind);
      for (orders.pop_back(); fit; orders.pop_back()) {
        Offer(*fit, &best);
        // With fewer coefficients the cost can only rise.
        if (orders.empty() || (best && fit->cost > Score(*best))) break;
        fit = FitOrder(*fit, orders.back(), edge_sigma_px);
      }
    }
    if (best) {
      LensFreedom freedom = best->freedom;
      freedom.aspect = true;
      const auto fit = Refit(*best, best->intrinsics, freedom, edge_sigma_px);
      if (fit) Offer(*fit, &best);
    }
    return best;
  }

  // From another fit of these views.
  std::optional<LensFit> Refit(const LensFit& fit, const CameraIntrinsics& start,
                               const LensFreedom& freedom, double edge_sigma_px) const {
    std::vector<LensView> views = views_;
    SetPoses(fit.camera_from_pattern, &views);
    return FitLens(views, start, freedom, edge_sigma_px);
  }

  // Takes what the fit cannot explain out of the views, and gives the others its poses. Returns how
  // many views were left out.
  int Clean(const LensFit& fit) {
    std::vector<double> errors;
    for (const auto& residuals : fit.residuals_px) {
      errors.push_back(SumOfMagnitudes(residuals) / static_cast<double>(residuals.size()));
    }
    std::vector<double> sorted = errors;
    std::sort(sorted.begin(), sorted.end());
    const double usual = sorted[sorted.size() / 2];
    const double limit_px = kOutlier * std::max(kLeastSigmaPx, RobustSigma(fit.residuals_px));
    std::vector<LensView> kept;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (errors[i] > kOutlierView * usual) continue;
      LensView view{views_[i].name, {}, fit.camera_from_pattern[i]};
      for (std::size_t k = 0; k < views_[i].edges.size(); ++k) {
        if (std::abs(fit.residuals_px[i][k]) <= limit_px) view.edges.push_back(views_[i].edges[k]);
      }
      kept.push_back(std::move(view));
    }
    const auto left_out = static_cast<int>(views_.size() - kept.size());
    views_ = std::move(kept);
    return left_out;
  }

  std::vector<LensView>& views() { return views_; }

 private:
  // With all coefficients of a kind.
  std::optional<LensFit> FitKind(const CameraIntrinsics& start, DistortionModel kind,
                                 double edge_sigma_px) const {
    const auto begin = Converted(start, kind, LargestRadiusPx(views_, start));
    if (!begin) return std::nullopt;
    const std::vector<int> orders = DistortionOrders(kind);
    const int few = std::min(1, orders.back());
    const auto rough = FitLens(views_, *begin, {.distortion = few}, edge_sigma_px);
    if (!rough || few == orders.back()) return rough;
    return FitOrder(*rough, orders.back(), edge_sigma_px);
  }

  // With the first 'order' coefficients; the others are 0.
  std::optional<LensFit> FitOrder(const LensFit& fit, int order, double edge_sigma_px) const {
    CameraIntrinsics start = fit.intrinsics;
    std::fill(start.distortion.begin() + order, start.distortion.end(), 0.0);
    return Refit(fit, start, {.distortion = order}, edge_sigma_px);
  }

  static void Offer(const LensFit& fit, std::optional<LensFit>* best) {
    if (IsValid(fit) && (!*best || Score(fit) < Score(**best))) *best = fit;
  }

  std::vector<LensView> views_;
  std::optional<DistortionModel> model_;
};

InputError CannotTell(const std::string& why) {
  return InputError("the views cannot tell the lens: " + why);
}

void RequireViews(std::size_t count) {
  if (count >= kMinViews) return;
  throw CannotTell(
      fmt::format("the pattern is in {} of them, near enough for its edges, expected at least {}",
                  count, kMinViews));
}

// The tilt of the print against the image plane that nine tenths of the views stay below, rad.
double UsualTilt(const std::vector<LensView>& views) {
  std::vector<double> tilts;
  for (const LensView& view : views) {
    const Eigen::Vector3d normal = view.camera_from_pattern.rotation * Eigen::Vector3d::UnitZ();
    tilts.push_back(std::acos(std::clamp(-normal.z(), -1.0, 1.0)));
  }
  std::sort(tilts.begin(), tilts.end());
  return tilts[tilts.size() * 9 / 10];
}

void RequireTold(const LensCalibration& calibration) {
  const double focal_sigma = calibration.fit.sigmas(kFocal) / calibration.intrinsics.fx_px;
  const std::string found =
      fmt::format("the standard deviation of the focal length is {:.2g} %", 100 * focal_sigma);
  const double tilt_deg = UsualTilt(calibration.views) * kDegrees;
  if (!(focal_sigma <= kMaxFocalSigma)) {
    if (tilt_deg < kLevelDeg) {
      throw CannotTell(fmt::format(
          "{}, for nearly all of them look straight at the pattern (tilt to {:.0f} degrees): tilt "
          "the camera or the pattern by 20 to 50 degrees, to different sides",
          found, tilt_deg));
    }
    throw CannotTell(fmt::format(
        "{}: take more views, near ones and with tilts of 20 to 50 degrees to different sides",
        found));
  }
  if (calibration.coverage.reach < kLeastReach) {
    throw CannotTell(fmt::format(
        "the pattern is only in the middle of the image (to {:.0f} % of the way to its corners): "
        "bring it to the border and into the corners",
        100 * calibration.coverage.reach));
  }
}

std::vector<std::string> Warnings(const LensCalibration& calibration) {
  std::vector<std::string> warnings;
  const double focal_sigma = calibration.fit.sigmas(kFocal) / calibration.intrinsics.fx_px;
  if (focal_sigma > kGoodFocalSigma) {
    warnings.push_back(
        fmt::format("the views hardly tell the focal length (standard deviation {:.2g} %): take "
                    "more, near ones "
                    "and with tilts of 20 to 50 degrees to different sides",
                    100 * focal_sigma));
  }
  const double sigma_px =
      std::max(calibration.fit.sigmas(kPrincipalX), calibration.fit.sigmas(kPrincipalY));
  if (sigma_px > kMaxPrincipalSigma * calibration.intrinsics.width_px) {
    warnings.push_back(fmt::format(
        "the views hardly tell the principal point (standard deviation {:.1f} px): tilt to "
        "different sides",
        sigma_px));
  }
  return warnings;
}

// What makes views differ: where the print lies in the image, how near, and its normal.
using ViewFeatures = Eigen::Vector<double, 6>;

ViewFeatures FeaturesOf(const LensView& view, int width_px) {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  for (const LensEdge& edge : view.edges) center += edge.pixel;
  center /= static_cast<double>(view.edges.size()) * width_px;
  const RigidTransform& pose = view.camera_from_pattern;
  ViewFeatures features;
  features << center, 0.3 * std::log(pose.translation.norm()),
      pose.rotation * Eigen::Vector3d::UnitZ();
  return features;
}

// At most so many of them, in their order, each as unlike the others as can be: a camera that
// hovers shows the same again and again, which says nothing more and outweighs what does.
std::vector<LensView> Thinned(const std::vector<LensView>& views, std::size_t max_views,
                              int width_px) {
  if (views.size() <= max_views) return views;
  std::vector<ViewFeatures> features;
  for (const LensView& view : views) features.push_back(FeaturesOf(view, width_px));
  std::vector<double> distances(views.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> chosen{0};
  while (chosen.size() < max_views) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      distances[i] = std::min(distances[i], (features[i] - features[chosen.back()]).norm());
    }
    chosen.push_back(std::max_element(distances.begin(), distances.end()) - distances.begin());
  }
  std::sort(chosen.begin(), chosen.end());
  std::vector<LensView> thinned;
  for (const std::size_t index : chosen) thinned.push_back(views[index]);
  return thinned;
}

// Lenses that an image of this size may come from: fields of view across it from 35 to 190
// degrees, a quarter apart in focal length.
std::vector<CameraIntrinsics> Guesses(const cv::Size& size) {
  constexpr std::array<double, 5> kPinholes{0.45, 0.6, 0.8, 1.1, 1.5};  // focal length over width
  constexpr std::array<double, 4> kFisheyes{0.25, 0.33, 0.43, 0.57};
  std::vector<CameraIntrinsics> guesses;
  const auto guess = [&](double focal, DistortionModel model) {
    guesses.push_back({size.width, size.height, focal * size.width, focal * size.width,
                       0.5 * (size.width - 1), 0.5 * (size.height - 1), model,
                       std::vector<double>(CoefficientCount(model))});
  };
  for (const double focal : kPinholes) guess(focal, DistortionModel::kNone);
  for (const double focal : kFisheyes) guess(focal, DistortionModel::kEquidistant);
  return guesses;
}

std::vector<LensView> FindViews(std::span<const LensImage> images, std::size_t stride,
                                const CameraIntrinsics& camera,
                                const LandingPatternDetectorOptions& options) {
  LensViewFinder finder(camera, options);
  std::vector<LensView> views;
  for (std::size_t i = 0; i < images.size(); i += stride) {
    std::optional<LensView> view = finder.Find(images[i].name, images[i].image);
    if (view) views.push_back(std::move(*view));
  }
  return views;
}

// The guess with which the pattern is found most often in a sample.
CameraIntrinsics BestGuess(std::span<const LensImage> images,
                           const LandingPatternDetectorOptions& options) {
  constexpr std::size_t kSample = 40;
  const std::size_t stride = std::max<std::size_t>(1, images.size() / kSample);
  CameraIntrinsics best;
  std::size_t most_edges = 0;
  for (const CameraIntrinsics& guess : Guesses(images.front().image.size())) {
    std::size_t edges = 0;
    for (const LensView& view : FindViews(images, stride, guess, options)) {
      edges += view.edges.size();
    }
    if (best.width_px == 0 || edges > most_edges) {
      most_edges = edges;
      best = guess;
    }
  }
  return best;
}

void RequireOneSize(std::span<const LensImage> images) {
  if (images.empty()) throw InputError("there are no images to calibrate the lens from");
  const cv::Size size = images.front().image.size();
  for (const LensImage& image : images) {
    if (image.image.size() == size) continue;
    throw InputError(fmt::format("{}: the image has {} x {} px, but {} has {} x {}", image.name,
                                 image.image.cols, image.image.rows, images.front().name,
                                 size.width, size.height));
  }
}

// The lens of at most 'max_views' views, told or not.
LensCalibration Estimate(const std::vector<LensView>& views, const CameraIntrinsics& start,
                         std::optional<DistortionModel> model, std::size_t max_views) {
  RequireViews(views.size());
  LensChoice choice(Thinned(views, max_views, start.width_px), model);
  LensCalibration calibration;
  calibration.found = views.size();
  const auto settle = [&](const CameraIntrinsics& lens) {
    std::optional<LensFit> fit;
    if (Resect(lens, &choice.views())) fit = choice.Begin(lens);
    if (!fit) throw CannotTell("no lens of this kind shows what they show");
    calibration.outliers += choice.Clean(*fit);
    RequireViews(choice.views().size());
    return *fit;
  };
  LensFit fit = settle(settle(start).intrinsics);
  const double sigma_px = std::max(kLeastSigmaPx, RobustSigma(fit.residuals_px));
  std::optional<LensFit> best = choice.Choose(fit.intrinsics, sigma_px);
  if (!best) throw CannotTell("no lens shows what they show");
  // Were edges independent, the optimism would be the number of parameters: as much as it is more,
  // less does an edge tell.
  const double alike = std::max(1.0, best->optimism / best->freedom.count());
  auto final_fit =
      choice.Refit(*best, best->intrinsics, best->freedom, std::sqrt(alike) * sigma_px);
  if (!final_fit) throw CannotTell("no lens shows what they show");
  calibration.intrinsics = Simplified(*final_fit);
  SetPoses(final_fit->camera_from_pattern, &choice.views());
  calibration.views = std::move(choice.views());
  calibration.coverage = CoverageOf(calibration.views, CameraModel(calibration.intrinsics));
  calibration.fit = std::move(*final_fit);
  calibration.warnings = Warnings(calibration);
  return calibration;
}

}  // namespace

LensCalibration EstimateLens(const std::vector<LensView>& views, const CameraIntrinsics& start,
                             std::optional<DistortionModel> model) {
  LensCalibration calibration = Estimate(views, start, model, kMaxViews);
  RequireTold(calibration);
  return calibration;
}

LensCalibration CalibrateLens(std::span<const LensImage> images,
                              const LensCalibrationOptions& options) {
  RequireOneSize(images);
  if (options.start) {
    const LensImage& first = images.front();
    CheckImageSize(CameraModel(*options.start), first.image.cols, first.image.rows, first.name);
  }
  CameraIntrinsics camera = options.start ? *options.start : BestGuess(images, options.detector);
  std::vector<LensView> views = FindViews(images, 1, camera, options.detector);
  // The better the lens, the more views are found, at the border of the image most of all.
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds && views.size() >= kMinViews; ++round) {
    camera = Estimate(views, camera, options.model, kFewViews).intrinsics;
    std::vector<LensView> more = FindViews(images, 1, camera, options.detector);
    if (more.size() <= views.size()) break;
    views = std::move(more);
  }
  return EstimateLens(views, camera, options.model);
}

}  // namespace kestrel
