// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/exposure_controller.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

// Share of the pixels that may be brighter: of an image, so that a glint or the sun does not
// darken everything else, and of the pattern's area, much of which is white.
constexpr double kImageShare = 0.01;
constexpr double kAreaShare = 0.1;
constexpr double kLargestStep = 8;  // factor of one change

constexpr int kSaturatedGray = 254;
constexpr int kMeterSamples = 5000;  // enough for a share of a hundredth

// The gray value before the camera's curve.
double BeforeGamma(double gray, double gamma) { return 255 * std::pow(gray / 255, 1 / gamma); }

// Counts the gray values of about kMeterSamples pixels across the image. Returns their number.
int CountGrays(const cv::Mat& image, std::array<int, 256>* histogram) {
  histogram->fill(0);
  const int step =
      std::max(1, static_cast<int>(std::sqrt(static_cast<double>(image.total()) / kMeterSamples)));
  int samples = 0;
  for (int v = step / 2; v < image.rows; v += step) {
    const auto* row = image.ptr<std::uint8_t>(v);
    for (int u = step / 2; u < image.cols; u += step) {
      ++(*histogram)[row[u]];
      ++samples;
    }
  }
  return samples;
}

// Returns the gray value that 'count' samples reach or exceed.
int BrightGray(const std::array<int, 256>& histogram, int count) {
  int gray = 255;
  for (int brighter = histogram[gray]; gray > 0 && brighter < count; brighter += histogram[gray]) {
    --gray;
  }
  return gray;
}

}  // namespace

std::vector<std::string> ExposureOptions::Validate() const {
  std::vector<std::string> violations;
  Require(high_gray, MoreThan(low_gray), "high_gray", &violations);
  Require(max_exposure_s, AtLeast(min_exposure_s), "max_exposure_s", &violations);
  Require(BeforeGamma(low_gray, gamma), MoreThan(black_gray), "low_gray, before gamma,",
          &violations);
  return violations;
}

ExposureController::ExposureController(const ExposureOptions& options, double exposure_s)
    : options_(options) {
  RequireValid(options);
  exposure_s_ = std::clamp(exposure_s, options.min_exposure_s, options.max_exposure_s);
}

double ExposureController::Update(const cv::Mat& image, const cv::Rect& area) {
  if (frames_to_wait_ > 0) {
    --frames_to_wait_;
    return exposure_s_;
  }
  const cv::Rect seen = area & cv::Rect({}, image.size());
  const bool whole = seen.empty();
  const int samples = CountGrays(whole ? image : image(seen), &histogram_);
  const double share = whole ? kImageShare : kAreaShare;
  const int gray = BrightGray(histogram_, std::max(1, static_cast<int>(share * samples)));
  const double exposure_s = std::clamp(exposure_s_ * StepFor(gray, samples),
                                       options_.min_exposure_s, options_.max_exposure_s);
  if (exposure_s == exposure_s_) return exposure_s_;
  exposure_s_ = exposure_s;
  frames_to_wait_ = options_.delay_frames;
  return exposure_s_;
}

double ExposureController::Linear(double gray) const {
  return BeforeGamma(gray, options_.gamma) - options_.black_gray;
}

// Returns the factor of the change of exposure. A saturated image does not show how far it is off;
// the more of it is saturated, the larger the step.
double ExposureController::StepFor(int bright_gray, int samples) const {
  constexpr double kLeastStep = 1.5;
  if (bright_gray >= kSaturatedGray) {
    const double share = std::accumulate(histogram_.begin() + kSaturatedGray, histogram_.end(), 0) /
                         static_cast<double>(samples);
    return 1 / (kLeastStep + share * (kLargestStep - kLeastStep));
  }
  if (bright_gray >= options_.low_gray && bright_gray <= options_.high_gray) return 1;
  const double wanted = Linear(0.5 * (options_.low_gray + options_.high_gray));
  const double seen = std::max(Linear(bright_gray), wanted / kLargestStep);
  return std::max(wanted / seen, 1 / kLargestStep);
}

}  // namespace kestrel
