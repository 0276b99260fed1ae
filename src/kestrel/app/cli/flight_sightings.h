// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/app/console/calibration_report.h"
#include "kestrel/calibration/mount/flight_calibration.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/io/recording/frame_source.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// Input of the calibration of mount and clock, for the command and for the console's page.

// Spacing of the knots for the path of a moving pattern.
inline constexpr double kMovingKnotSpacing_s = 2;

// Returns mount and clock of a calibration. Throws InputError when it has no mount. 'file': its
// name, for the error.
MountAndClock GivenMountAndClock(const CameraCalibration& calibration, const std::string& file);
// Replaces mount and clock of a calibration by an estimate.
void SetMountAndClock(const MountAndClock& estimate, CameraCalibration* calibration);

// Returns the poses of a flight. Throws InputError when there are none. 'name': name of the source,
// for the error.
std::vector<PoseSample> FlightPoses(const FrameSource& source, const std::string& name);

// Finds the pattern in each frame independently.
class FlightSightings {
 public:
  // Throws InputError when camera or options are not valid.
  FlightSightings(const CameraIntrinsics& camera, const LandingPipelineOptions& options);

  // The frame must have the size of the camera's images.
  void Add(const Frame& frame);

  const std::vector<TargetSighting>& sightings() const { return sightings_; }
  const std::vector<PatternPlace>& places() const { return places_; }

 private:
  LandingPatternDetector detector_;
  LandingWorkspace workspace_;
  MeasurementNoise noise_;
  std::vector<TargetSighting> sightings_;
  std::vector<PatternPlace> places_;  // one for each sighting
};

}  // namespace kestrel
