// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"
#include "kestrel/flight/session/flight_report.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// The doctor's checks of a flight, from what the flight sees anyway: calibration, camera, mount and
// computer by its newest frames. Link and parameters of the autopilot are not looked at, nor what
// only a doctor's own look can tell: the focal length and the mount by the motion. By one thread.
class FlightExamination {
 public:
  // 'record': the folder that recordings go to; 'least_disk_mb': that the recorder leaves.
  FlightExamination(const CameraCalibration& calibration, const std::string& record,
                    double least_disk_mb);

  // A frame that reached the vision, in order.
  void AddFrame(const FrameSample& frame);
  // What was seen in a frame; not every one has to be told.
  void Look(const cv::Mat& image, Time now);
  void Look(const LandingObservation& observation);

  // All checks of what was told so far.
  std::vector<Finding> Check(const FlightReport& report) const;

 private:
  CameraCalibration calibration_;
  DoctorUse use_;
  double least_disk_mb_;
  int width_px_ = 0;
  int height_px_ = 0;
  std::deque<FrameSample> frames_;
  std::deque<ImageQuality> qualities_;
  std::deque<PatternSample> patterns_;
  std::deque<double> detect_s_;
  Time looked_{};
};

}  // namespace kestrel
