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

// What mount and clock are calibrated from, by the command and by the console's page.

// Of the path of a pattern that moves.
inline constexpr double kMovingKnotSpacing_s = 2;

// The values that a calibration has. Throws InputError when it has no mount; 'file': for that.
MountAndClock GivenMountAndClock(const CameraCalibration& calibration, const std::string& file);
// Puts an estimate in their place.
void SetMountAndClock(const MountAndClock& estimate, CameraCalibration* calibration);

// The poses of a flight. Throws InputError when there are none; 'name': of the source.
std::vector<PoseSample> FlightPoses(const FrameSource& source, const std::string& name);

// Finds the pattern in every frame for itself.
class FlightSightings {
 public:
  // Throws InputError when camera or options are not valid.
  FlightSightings(const CameraIntrinsics& camera, const LandingPipelineOptions& options);

  // A frame of the camera's size.
  void Add(const Frame& frame);

  const std::vector<TargetSighting>& sightings() const { return sightings_; }
  const std::vector<PatternPlace>& places() const { return places_; }

 private:
  LandingPatternDetector detector_;
  LandingWorkspace workspace_;
  MeasurementNoise noise_;
  std::vector<TargetSighting> sightings_;
  std::vector<PatternPlace> places_;  // of the same frames
};

}  // namespace kestrel
