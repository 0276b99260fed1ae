// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/exposure_controller.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include <fmt/format.h>

#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

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
  const auto require = [&](bool holds, const std::string& rule) {
    if (!holds) violations.push_back(rule);
  };
  require(low_gray > 0 && low_gray < high_gray && high_gray < kSaturatedGray,
          fmt::format("low_gray and high_gray are {} and {}, expected 0 < low < high < {}",
                      low_gray, high_gray, kSaturatedGray));
  require(image_share >= 0 && image_share < 1, "image_share must be in [0, 1)");
  require(area_share >= 0 && area_share < 1, "area_share must be in [0, 1)");
  require(gamma >= 0.1 && gamma <= 3, "gamma must be 0.1 to 3");
  require(black_gray >= 0 && black_gray < 100, "black_gray must be 0 to 100");
  require(delay_frames >= 0 && delay_frames <= 100, "delay_frames must be 0 to 100");
  require(min_exposure_s > 0 && min_exposure_s <= max_exposure_s && std::isfinite(max_exposure_s),
          fmt::format("min_exposure_s and max_exposure_s are {} and {}, expected 0 < min <= max",
                      min_exposure_s, max_exposure_s));
  require(largest_step > 1 && std::isfinite(largest_step), "largest_step must be above 1");
  if (violations.empty()) {
    require(BeforeGamma(low_gray, gamma) > black_gray, "black_gray must be darker than low_gray");
  }
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
  const double share = whole ? options_.image_share : options_.area_share;
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
    const double least = std::min(kLeastStep, options_.largest_step);
    return 1 / (least + share * (options_.largest_step - least));
  }
  if (bright_gray >= options_.low_gray && bright_gray <= options_.high_gray) return 1;
  const double wanted = Linear(0.5 * (options_.low_gray + options_.high_gray));
  const double seen = std::max(Linear(bright_gray), wanted / options_.largest_step);
  return std::max(wanted / seen, 1 / options_.largest_step);
}

}  // namespace kestrel
