// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"

namespace kestrel {

// A length of a print, m, with its standard deviation.
struct MeasuredLength {
  double value_m;
  double sigma_m;
};

// The dimensions of a print in a photograph, relative to the configured outer diameter, as a
// photograph has no scale.
struct PrintMeasurement {
  MeasuredLength ring_width;
  MeasuredLength arm_width;
  // Nothing when no ends are seen: the arms reach the ring, or the gap is too narrow for the image.
  std::optional<MeasuredLength> arm_half_length;
  MeasuredLength distance;  // from the camera to the middle of the print
  double pixel_m;           // size of a pixel on the print, there
  double ring_px;           // diameter of the ring in the image
};

// Measures the print in 'image' (CV_8UC1), which should show all of it. 'camera': has the image's
// size; without it a pinhole camera with little distortion is assumed, and the distance is
// meaningless. Dimensions may be up to half larger or a third smaller than those of 'options'. The
// standard deviations include the scatter of the edges, the spread of white over black, and the
// uncertainty of the lens. Returns nothing when the pattern is not found or is too small to be
// measured. Throws InputError when camera or options are not valid.
std::optional<PrintMeasurement> MeasurePrint(const cv::Mat& image,
                                             const std::optional<CameraIntrinsics>& camera,
                                             const LandingPatternDetectorOptions& options);

}  // namespace kestrel
