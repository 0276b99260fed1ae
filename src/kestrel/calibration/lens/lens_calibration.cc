// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens/lens_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "kestrel/calibration/lens/board_view.h"
#include "kestrel/calibration/lens/lens_choice.h"
#include "kestrel/calibration/lens/unlike_views.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

// Numbers of views: fewer are refused; fewer hardly determine their own scatter; the most used.
constexpr std::size_t kMinViews = 8;
constexpr std::size_t kGoodViews = 20;
constexpr std::size_t kMaxViews = 100;
constexpr std::size_t kFewViews = 40;  // enough to find more views with
// Standard deviations of the focal length, relative: above the first there is no calibration, above
// the second it is not a good one.
constexpr double kMaxFocalSigma = 0.05;
constexpr double kGoodFocalSigma = 0.01;
constexpr double kMaxPrincipalSigma = 0.01;  // share of the image's width
constexpr double kLeastReach = 0.35;         // least good reach, in halves of the diagonal
constexpr double kLevelDeg = 12;             // views with less tilt face the pattern
InputError NotDetermined(const std::string& why) {
  return InputError("the views cannot tell the lens: " + why);
}

void RequireViews(std::size_t count) {
  if (count >= kMinViews) return;
  throw NotDetermined(
      fmt::format("the pattern is in {} of them, near enough for its edges, expected at least {}",
                  count, kMinViews));
}

// The tilt of the print against the image plane that nine tenths of the views do not exceed, rad.
double UsualTilt(const std::vector<LensView>& views) {
  std::vector<double> tilts;
  for (const LensView& view : views) {
    const Eigen::Vector3d normal = view.camera_from_target.rotation * Eigen::Vector3d::UnitZ();
    tilts.push_back(std::acos(std::clamp(-normal.z(), -1.0, 1.0)));
  }
  std::sort(tilts.begin(), tilts.end());
  return tilts[tilts.size() * 9 / 10];
}

void RequireDetermined(const LensCalibration& calibration) {
  const double focal_sigma = calibration.fit.sigmas(kFocal) / calibration.intrinsics.fx_px;
  const std::string found =
      fmt::format("the standard deviation of the focal length is {:.2g} %", 100 * focal_sigma);
  const double tilt_deg = Degrees(UsualTilt(calibration.views));
  if (!(focal_sigma <= kMaxFocalSigma)) {
    if (tilt_deg < kLevelDeg) {
      throw NotDetermined(fmt::format(
          "{}, for nearly all of them look straight at the pattern (tilt to {:.0f} degrees): tilt "
          "the camera or the pattern by 20 to 50 degrees, to different sides",
          found, tilt_deg));
    }
    throw NotDetermined(fmt::format(
        "{}: take more views, near ones and with tilts of 20 to 50 degrees to different sides",
        found));
  }
  if (calibration.coverage.reach < kLeastReach) {
    throw NotDetermined(fmt::format(
        "the pattern is only in the middle of the image (to {:.0f} % of the way to its corners): "
        "bring it to the border and into the corners",
        100 * calibration.coverage.reach));
  }
}

std::vector<std::string> Warnings(const LensCalibration& calibration) {
  std::vector<std::string> warnings;
  if (calibration.views.size() < kGoodViews) {
    warnings.push_back(fmt::format(
        "{} views are few: the errors may be larger than the standard deviations say, take thirty",
        calibration.views.size()));
  }
  const double focal_sigma = calibration.fit.sigmas(kFocal) / calibration.intrinsics.fx_px;
  if (focal_sigma > kGoodFocalSigma) {
    warnings.push_back(fmt::format(
        "the views hardly determine the focal length (standard deviation {:.2g} %): take "
        "more, near ones and with tilts of 20 to 50 degrees to different sides",
        100 * focal_sigma));
  }
  const double sigma_px =
      std::max(calibration.fit.sigmas(kPrincipalX), calibration.fit.sigmas(kPrincipalY));
  if (sigma_px > kMaxPrincipalSigma * calibration.intrinsics.width_px) {
    warnings.push_back(fmt::format(
        "the views hardly determine the principal point (standard deviation {:.1f} px): tilt to "
        "different sides",
        sigma_px));
  }
  return warnings;
}

std::vector<LensView> FindViews(std::span<const LensImage> images, std::size_t stride,
                                const CameraIntrinsics& camera,
                                const LensCalibrationOptions& options) {
  LensViewFinder finder(camera, options.detector);
  std::vector<LensView> views;
  for (std::size_t i = 0; i < images.size(); i += stride) {
    if (options.before_image) options.before_image();
    std::optional<LensView> view = finder.Find(images[i].name, images[i].image);
    if (view) views.push_back(std::move(*view));
  }
  return views;
}

// The guess with which the pattern is found in the most images of a sample.
CameraIntrinsics BestGuess(std::span<const LensImage> images,
                           const LensCalibrationOptions& options) {
  constexpr std::size_t kSample = 40;
  const std::size_t stride = std::max<std::size_t>(1, images.size() / kSample);
  CameraIntrinsics best;
  std::size_t most_edges = 0;
  for (const CameraIntrinsics& guess : LensGuesses(images.front().image.size())) {
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

// Estimates the lens from at most 'max_views' views, whether they determine it or not.
LensCalibration Estimate(const std::vector<LensView>& views, const CameraIntrinsics& start,
                         std::optional<DistortionModel> model, std::size_t max_views) {
  RequireViews(views.size());
  LensChoice choice(UnlikeViews(views, max_views, start.width_px), model);
  std::optional<CameraIntrinsics> near = start;
  constexpr int kApproaches = 2;
  for (int i = 0; near && i < kApproaches; ++i) {
    near = choice.Approach(*near);
    RequireViews(choice.views().size());
  }
  std::optional<LensFit> fit = near ? choice.Choose(*near) : std::nullopt;
  if (!fit) throw NotDetermined("no lens of this kind shows what they show");
  LensCalibration calibration;
  calibration.intrinsics = fit->Simplified();
  calibration.fit = std::move(*fit);
  calibration.found = views.size();
  calibration.views = choice.views();
  calibration.outliers = choice.outliers();
  calibration.coverage = CoverageOf(calibration.views, CameraModel(calibration.intrinsics));
  calibration.warnings = Warnings(calibration);
  return calibration;
}

// The corners of the board in all images. Their poses are by a guess.
std::vector<LensView> FindBoards(std::span<const LensImage> images,
                                 const LensCalibrationOptions& options) {
  const CameraIntrinsics guess = LensGuesses(images.front().image.size()).front();
  std::vector<LensView> views;
  for (const LensImage& image : images) {
    if (options.before_image) options.before_image();
    std::optional<LensView> view = FindBoard(image.name, image.image, *options.board, guess);
    if (view) views.push_back(std::move(*view));
  }
  return views;
}

}  // namespace

std::vector<CameraIntrinsics> LensGuesses(const cv::Size& size) {
  constexpr std::array<double, 5> kPinholes{0.45, 0.6, 0.8, 1.1, 1.5};  // focal length over width
  constexpr std::array<double, 4> kFisheyes{0.25, 0.33, 0.43, 0.57};
  std::vector<CameraIntrinsics> guesses;
  const auto guess = [&](double focal, DistortionModel model) {
    guesses.push_back({size.width,
                       size.height,
                       focal * size.width,
                       focal * size.width,
                       0.5 * (size.width - 1),
                       0.5 * (size.height - 1),
                       model,
                       {}});
    if (model == DistortionModel::kEquidistant) guesses.back().distortion.resize(4);
  };
  for (const double focal : kPinholes) guess(focal, DistortionModel::kNone);
  for (const double focal : kFisheyes) guess(focal, DistortionModel::kEquidistant);
  return guesses;
}

LensCalibration EstimateLens(const std::vector<LensView>& views, const CameraIntrinsics& start,
                             std::optional<DistortionModel> model) {
  LensCalibration calibration = Estimate(views, start, model, kMaxViews);
  RequireDetermined(calibration);
  return calibration;
}

LensCalibration EstimateBoardLens(const std::vector<LensView>& views, const cv::Size& size,
                                  std::optional<DistortionModel> model) {
  RequireViews(views.size());
  const CameraIntrinsics start = LikeliestLens(LensGuesses(size), views);
  return EstimateLens(PosedBy(start, views), start, model);
}

LensCalibration CalibrateLens(std::span<const LensImage> images,
                              const LensCalibrationOptions& options) {
  RequireOneSize(images);
  if (options.start) {
    const LensImage& first = images.front();
    CheckImageSize(*options.start, first.image.cols, first.image.rows, first.name);
  }
  if (options.board) {
    const std::vector<LensView> views = FindBoards(images, options);
    if (!options.start) {
      return EstimateBoardLens(views, images.front().image.size(), options.model);
    }
    return EstimateLens(PosedBy(*options.start, views), *options.start, options.model);
  }
  CameraIntrinsics camera = options.start ? *options.start : BestGuess(images, options);
  std::vector<LensView> views = FindViews(images, 1, camera, options);
  // A better lens finds more views, above all at the border of the image.
  constexpr int kSearches = 3;
  for (int round = 0; round < kSearches && views.size() >= kMinViews; ++round) {
    camera = Estimate(views, camera, options.model, kFewViews).intrinsics;
    std::vector<LensView> more = FindViews(images, 1, camera, options);
    if (more.size() <= views.size()) break;
    views = std::move(more);
  }
  return EstimateLens(views, camera, options.model);
}

}  // namespace kestrel
