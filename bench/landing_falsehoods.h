// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/simulation/labelled_images/landing_stills.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "landing_frames.h"

namespace kestrel {

// A wrong calibration: another unit of the lens, a zoom, a crop, a guess.
struct CalibrationError {
  std::string_view name;
  CameraIntrinsics (*apply)(CameraIntrinsics camera);
};
// Returns all of them; the first changes nothing.
std::span<const CalibrationError> CalibrationErrors();

// A print that is not flat.
struct PrintError {
  std::string_view name;
  double bulge;  // as in LandingStillOptions
  double fold;
  double rolling_skew;
};
// Returns all of them; the first one is flat.
std::span<const PrintError> PrintErrors();

// Returns makers of stills with such a print, one for each of kAltitudeBins.
std::vector<LandingStillMaker> StillMakers(const PrintError& print);

// Renders this number of stills for each of kAltitudeBins, the same in every run.
LandingFrameSet RenderStills(int per_altitude, const PrintError& print, int threads);

// A hint of a caller about a frame with known pose, right or wrong.
struct GivenHint {
  std::string_view name;
  TargetHint (*make)(const LandingFrame& frame);
};
std::span<const GivenHint> GivenHints();

}  // namespace kestrel
