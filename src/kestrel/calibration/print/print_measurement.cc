// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/print/print_measurement.h"

#include <algorithm>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "kestrel/calibration/print/print_fit.h"
#include "kestrel/calibration/print/print_lines.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

constexpr double kLargest_px = 1600;  // side of the image in which the pattern is searched

CameraIntrinsics Pinhole(const cv::Size& size, double focal_px) {
  return {size.width,
          size.height,
          focal_px,
          focal_px,
          0.5 * (size.width - 1),
          0.5 * (size.height - 1),
          DistortionModel::kNone,
          {}};
}

// Lenses of telephones and cameras, the most likely first.
std::vector<CameraIntrinsics> LikelyCameras(const cv::Size& size) {
  std::vector<CameraIntrinsics> cameras;
  const double side = std::max(size.width, size.height);
  for (const double focal : {0.75, 1.2, 0.5}) cameras.push_back(Pinhole(size, focal * side));
  return cameras;
}

CameraIntrinsics Scaled(CameraIntrinsics camera, const cv::Size& size) {
  const double x = static_cast<double>(size.width) / camera.width_px;
  const double y = static_cast<double>(size.height) / camera.height_px;
  camera.width_px = size.width;
  camera.height_px = size.height;
  camera.fx_px *= x;
  camera.fy_px *= y;
  camera.cx_px = x * (camera.cx_px + 0.5) - 0.5;
  camera.cy_px = y * (camera.cy_px + 0.5) - 0.5;
  return camera;
}

// The pattern itself, then prints that were made for other configurations.
std::vector<LandingPattern> LikelyPatterns(const LandingPattern& pattern) {
  std::vector<LandingPattern> patterns{pattern};
  for (const double ring : {1.0, 0.7, 1.4}) {
    for (const double arm : {1.0, 0.7, 1.4}) {
      for (const double length : {1.0, 0.8, 1.15}) {
        LandingPattern other = pattern;
        other.ring_width_m *= ring;
        other.arm_width_m *= arm;
        other.arm_half_length_m *= length;
        if (ViolationsOf(other).empty()) patterns.push_back(other);
      }
    }
  }
  return patterns;
}

// The prior of a calibrated lens, or of an assumed one.
LensPrior PriorOf(const CameraIntrinsics& camera, bool is_calibrated) {
  return is_calibrated ? LensPrior{0.003, 0.002, camera.fx_px} : LensPrior{0.4, 0.03, camera.fx_px};
}

// Finds and measures a print, trying one assumption about camera and pattern after the other.
class PrintSearch {
 public:
  explicit PrintSearch(const cv::Mat& image) : image_(image), small_(image) {
    const double scale = kLargest_px / std::max(image.cols, image.rows);
    if (scale < 1) cv::resize(image, small_, cv::Size(), scale, scale, cv::INTER_AREA);
  }

  std::optional<PrintFit> Measure(const CameraIntrinsics& camera, const LensPrior& lens,
                                  const LandingPatternDetectorOptions& options) {
    const LandingPatternDetector detector(CameraModel(Scaled(camera, small_.size())), options);
    const TargetReport report = detector.Detect(small_, {}, workspace_);
    if (!report.detection) return std::nullopt;
    const double ring_px = 2 * report.detection->semi_major_px * image_.cols / small_.cols;
    const FoundPrint found{camera, report.detection->camera_from_target, options.pattern,
                           options.pattern.outer_diameter_m / ring_px};
    // Repeated with the measured pattern, whose lines cross the outlines better.
    std::optional<PrintFit> fit = Fit(found, lens);
    if (!fit || !ViolationsOf(fit->print.pattern).empty()) return std::nullopt;
    return Fit(fit->print, lens);
  }

 private:
  std::optional<PrintFit> Fit(const FoundPrint& print, const LensPrior& lens) const {
    return FitPrint(FindPrintLineEdges(image_, CameraModel(print.camera), print.camera_from_target,
                                       print.pattern),
                    lens, print);
  }

  cv::Mat image_;
  cv::Mat small_;
  LandingWorkspace workspace_;
};

}  // namespace

std::optional<PrintMeasurement> MeasurePrint(const cv::Mat& image,
                                             const std::optional<CameraIntrinsics>& camera,
                                             const LandingPatternDetectorOptions& options) {
  const std::vector<CameraIntrinsics> cameras =
      camera ? std::vector{*camera} : LikelyCameras(image.size());
  PrintSearch search(image);
  LandingPatternDetectorOptions likely = options;
  for (const LandingPattern& pattern : LikelyPatterns(options.pattern)) {
    likely.pattern = pattern;
    for (const CameraIntrinsics& assumed : cameras) {
      const auto fit =
          search.Measure(assumed, PriorOf(cameras.front(), camera.has_value()), likely);
      if (fit && fit->is_consistent) return fit->measurement;
    }
  }
  return std::nullopt;
}

}  // namespace kestrel
