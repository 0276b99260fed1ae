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

// The doctor's checks of a flight, made from the flight's newest frames: calibration, camera, mount
// and computer. It does not check the link or the autopilot's parameters, nor what only a doctor's
// own examination can show: the focal length, and the mount by motion. Used by one thread.
class FlightExamination {
 public:
  // 'record': folder of the recordings. 'least_disk_mb': room that the recorder leaves free.
  FlightExamination(const CameraCalibration& calibration, const std::string& record,
                    double least_disk_mb);

  // Adds a frame that has reached the vision, in order.
  void AddFrame(const FrameSample& frame);
  // Adds the contents of a frame; not every frame is needed.
  void Look(const cv::Mat& image, Time now);
  void Look(const LandingObservation& observation);

  // Runs all checks on what was added so far.
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
