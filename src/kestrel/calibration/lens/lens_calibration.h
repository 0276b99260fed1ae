// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/calibration/lens/lens_coverage.h"
#include "kestrel/calibration/lens/lens_fit.h"
#include "kestrel/calibration/lens/lens_view.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"

namespace kestrel {

// A lens as views of the landing pattern have it.
struct LensCalibration {
  CameraIntrinsics intrinsics;
  LensFit fit;                  // of the same lens, with its standard deviations
  std::size_t found = 0;        // views in which the pattern was found, near enough
  std::vector<LensView> views;  // those that were used, as 'fit' has them: not too many alike
  int outliers = 0;             // views that do not fit and were left out
  LensCoverage coverage;
  // What the views do not tell well, in words.
  std::vector<std::string> warnings;
};

// The lens that explains the views best, from one that is near (to 30 % of the focal length).
// 'model': its kind; without it the kind and how many coefficients it has are those that promise
// the least error on other views of the same kind (Takeuchi's information criterion, with the
// penalty of BIC). Throws InputError with what is to be done when the views cannot tell the lens.
LensCalibration EstimateLens(const std::vector<LensView>& views, const CameraIntrinsics& start,
                             std::optional<DistortionModel> model = {});

// An image of the landing pattern, or without it.
struct LensImage {
  std::string name;
  cv::Mat image;  // CV_8UC1
};

struct LensCalibrationOptions {
  std::optional<DistortionModel> model;   // as of EstimateLens
  std::optional<CameraIntrinsics> start;  // a guess of the lens; without it several are tried
  LandingPatternDetectorOptions detector;
  // Called before the pattern is looked for in an image; what it throws ends the calibration. May
  // be empty.
  std::function<void()> before_image = {};
};

// The lens of a camera from images of one size, in any order: the pattern is detected with guesses
// of the lens, the lens is estimated from its edges, and with that lens the pattern is looked for
// again. Throws InputError as EstimateLens does, and when the sizes differ or are not that of
// 'start'.
LensCalibration CalibrateLens(std::span<const LensImage> images,
                              const LensCalibrationOptions& options);

}  // namespace kestrel
