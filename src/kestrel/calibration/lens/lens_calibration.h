// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/calibration/lens/lens_board.h"
#include "kestrel/calibration/lens/lens_coverage.h"
#include "kestrel/calibration/lens/lens_fit.h"
#include "kestrel/calibration/lens/lens_view.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"

namespace kestrel {

// A lens estimated from views of the landing pattern.
struct LensCalibration {
  CameraIntrinsics intrinsics;
  LensFit fit;                  // fit of this lens, with its standard deviations
  std::size_t found = 0;        // views in which the pattern was found, large enough
  std::vector<LensView> views;  // the views that were used, with the poses of 'fit'
  int outliers = 0;             // views that do not fit and were left out
  LensCoverage coverage;
  // Quantities that the views do not determine well, in words.
  std::vector<std::string> warnings;
};

// Returns the lens that explains the views best, starting from one with a similar focal length (to
// 30 %). 'model': the distortion model. Without it the model and its number of coefficients are
// those with the least expected error on other views of the same kind (Takeuchi's information
// criterion, with the penalty of BIC). Throws InputError with advice when the views do not
// determine the lens.
LensCalibration EstimateLens(const std::vector<LensView>& views, const CameraIntrinsics& start,
                             std::optional<DistortionModel> model = {});

// An image with or without the landing pattern.
struct LensImage {
  std::string name;
  cv::Mat image;  // CV_8UC1
};

struct LensCalibrationOptions {
  std::optional<DistortionModel> model;   // as in EstimateLens
  std::optional<CameraIntrinsics> start;  // a guess of the lens; without it several are tried
  LandingPatternDetectorOptions detector;
  std::optional<LensBoard> board = {};  // what the images show in place of the landing pattern
  // Called before each image is searched for the pattern; an exception from it ends the
  // calibration. May be empty.
  std::function<void()> before_image = {};
};

// Possible lenses of images of this size: fields of view across it from 35 to 190 degrees, in steps
// of a third of the focal length.
std::vector<CameraIntrinsics> LensGuesses(const cv::Size& size);

// Estimates the lens as EstimateLens does, from views of a board in images of this size, starting
// from the guess that explains them best.
LensCalibration EstimateBoardLens(const std::vector<LensView>& views, const cv::Size& size,
                                  std::optional<DistortionModel> model = {});

// Calibrates a camera from images of one size, in any order: it detects the pattern with guesses of
// the lens, estimates the lens from the pattern's edges, and detects the pattern again with that
// lens. A board's corners are found once, as no lens is needed for that. Throws InputError as
// EstimateLens does, and when the sizes of the images differ from each other or from that of
// 'start'.
LensCalibration CalibrateLens(std::span<const LensImage> images,
                              const LensCalibrationOptions& options);

}  // namespace kestrel
