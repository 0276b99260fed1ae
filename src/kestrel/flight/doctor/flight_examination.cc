// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/flight_examination.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include "kestrel/flight/doctor/calibration_checks.h"
#include "kestrel/flight/doctor/camera_checks.h"
#include "kestrel/flight/doctor/computer_checks.h"
#include "kestrel/flight/doctor/examination.h"
#include "kestrel/flight/doctor/mount_checks.h"
#include "kestrel/flight/doctor/statistics.h"

namespace kestrel {
namespace {

// About the newest ten seconds.
constexpr std::size_t kSamples = 300;
constexpr std::size_t kQualities = 20;
constexpr Duration kQualityInterval = std::chrono::milliseconds(500);

template <class T>
void AddNewest(const T& value, std::size_t capacity, std::deque<T>* values) {
  values->push_back(value);
  if (values->size() > capacity) values->pop_front();
}

template <class T>
std::vector<T> ListOf(const std::deque<T>& values) {
  return {values.begin(), values.end()};
}

}  // namespace

FlightExamination::FlightExamination(const CameraCalibration& calibration,
                                     const std::string& record, double least_disk_mb)
    : calibration_(calibration), least_disk_mb_(least_disk_mb) {
  use_.record = record;
}

void FlightExamination::AddFrame(const FrameSample& frame) { AddNewest(frame, kSamples, &frames_); }

void FlightExamination::Look(const cv::Mat& image, Time now) {
  width_px_ = image.cols;
  height_px_ = image.rows;
  if (now - looked_ < kQualityInterval) return;
  looked_ = now;
  AddNewest(MeasureImageQuality(image), kQualities, &qualities_);
}

void FlightExamination::Look(const LandingObservation& observation) {
  AddNewest(ToSeconds(observation.detect_time), kSamples, &detect_s_);
  const auto& detection = observation.report.detection;
  if (!detection) return;
  PatternSample sample = PatternSampleOf(*detection);
  sample.time = observation.time + calibration_.clock_offset.value_or(Duration::zero());
  if (observation.world_from_camera && observation.camera_from_body) {
    sample.world_from_body = *observation.world_from_camera * *observation.camera_from_body;
  }
  AddNewest(sample, kSamples, &patterns_);
}

std::vector<Finding> FlightExamination::Check(const FlightReport& report) const {
  DoctorObservations all;
  all.use = use_;
  all.calibration = calibration_;
  all.camera.error = report.trouble;
  all.camera.width_px = width_px_;
  all.camera.height_px = height_px_;
  all.camera.frames = ListOf(frames_);
  all.camera.qualities = ListOf(qualities_);
  all.camera.counters = report.capture;
  all.camera.is_on_ground =
      report.autopilot && report.autopilot->is_here && !report.autopilot->is_armed;
  if (!frames_.empty()) {
    all.camera.duration_s = ToSeconds(frames_.back().arrival - frames_.front().arrival);
  }
  all.vision.frames = static_cast<int>(report.events.frames);
  all.vision.dropped_frames = static_cast<int>(report.events.dropped_frames);
  all.vision.patterns = ListOf(patterns_);
  if (!detect_s_.empty()) {
    constexpr double kMostOf = 0.9;
    all.vision.detect_s = MedianOf(ListOf(detect_s_));
    all.vision.detect_p90_s = QuantileOf(ListOf(detect_s_), kMostOf);
  }
  constexpr double kMega = 1e6;
  all.computer = ObserveComputer(use_.record);
  all.computer.frame_mb = width_px_ * height_px_ / kMega;
  all.computer.least_disk_mb = least_disk_mb_;
  std::vector<Finding> findings;
  const auto& mount = calibration_.body_from_camera;
  // The mount is not judged by motion: the target may turn.
  const std::vector<Finding> mounted =
      calibration_.gimbal
          ? std::vector{CheckGimbalMount()}
          : std::vector{CheckMountGiven(mount), CheckMountByGravity(mount, all.vision)};
  for (const auto& part :
       {CheckCalibration(all), CheckCamera(all.camera), mounted, CheckComputer(all)}) {
    findings.insert(findings.end(), part.begin(), part.end());
  }
  return findings;
}

}  // namespace kestrel
