// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/calibration/mount/flight_calibration.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"
#include "kestrel/vision/pipeline/measurement_noise.h"
#include "kestrel/vision/target/target_detector.h"

namespace kestrel {

// Spacing of the knots for the path of a moving pattern.
inline constexpr double kMovingKnotSpacing_s = 2;

// Returns mount and clock of a calibration, of its gimbal if it has one. Throws InputError when it
// has no mount. 'file': its name, for the error.
MountAndClock GivenMountAndClock(const CameraCalibration& calibration, const std::string& file);
// Returns the gimbal of a flight; nothing when the camera is on none. Throws InputError when the
// source has no reports of it.
std::optional<FlownGimbal> FlownGimbalOf(const CameraCalibration& calibration,
                                         std::vector<GimbalSample> reports,
                                         const std::string& file);
// Throws InputError where the lens has zoomed: a flight is calibrated with the file's own lens.
// 'reports': of the zoom that the calibration may have; 'file': of the flight.
void RequireOwnLens(const CameraCalibration& calibration, const std::vector<ZoomSample>& reports,
                    const std::string& file);

// Replaces mount and clock of a calibration by an estimate.
void SetMountAndClock(const MountAndClock& estimate, CameraCalibration* calibration);

// A place of the pattern in one image of a flight.
struct PatternPlace {
  cv::Point2f pixel;  // its centre
  double height_m;    // height of the camera above it
};

// The input of CalibrateFlight from images: finds the pattern in each of them independently.
class FlightSightings {
 public:
  // Throws InputError when camera or options are not valid.
  FlightSightings(const CameraIntrinsics& camera, const LandingPipelineOptions& options);

  // 'image': CV_8UC1, of the camera's size. 'time': middle of its exposure, on the images' clock.
  void Add(const cv::Mat& image, Time time);

  const std::vector<TargetSighting>& sightings() const { return sightings_; }
  const std::vector<PatternPlace>& places() const { return places_; }

 private:
  std::unique_ptr<const TargetDetector> detector_;
  std::unique_ptr<TargetWorkspace> workspace_;
  MeasurementNoise noise_;
  std::vector<TargetSighting> sightings_;
  std::vector<PatternPlace> places_;  // one for each sighting
};

}  // namespace kestrel
