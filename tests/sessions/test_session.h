// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/onboard/session.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/flight/session/observation_sink.h"
#include "kestrel/vision/mapping/team_object.h"

namespace kestrel {

inline constexpr int kWidth_px = 160;
inline constexpr int kHeight_px = 120;
inline constexpr Duration kFramePeriod = std::chrono::milliseconds(10);
inline constexpr double kRate_hz = 100;

// The camera looks straight down.
inline CameraCalibration SmallCamera() {
  CameraCalibration calibration;
  calibration.intrinsics = {.width_px = kWidth_px,
                            .height_px = kHeight_px,
                            .fx_px = 150,
                            .fy_px = 150,
                            .cx_px = 79.5,
                            .cy_px = 59.5,
                            .distortion = {}};
  calibration.body_from_camera = RigidTransform{{0, 1, 0, 0}, {0, 0, 0}};
  return calibration;
}

// The landing pattern 3 m below: a ring with a cross, on a bright board.
inline cv::Mat PatternImage(int shift_px) {
  cv::Mat image(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(120));
  const cv::Point center(70 + shift_px % 20, 60);
  cv::rectangle(image, center - cv::Point(38, 38), center + cv::Point(38, 38), 220, cv::FILLED);
  cv::circle(image, center, 25, 30, cv::FILLED, cv::LINE_AA);
  cv::circle(image, center, 20, 220, cv::FILLED, cv::LINE_AA);
  cv::rectangle(image, center - cv::Point(19, 3), center + cv::Point(19, 3), 30, cv::FILLED);
  cv::rectangle(image, center - cv::Point(3, 19), center + cv::Point(3, 19), 30, cv::FILLED);
  cv::GaussianBlur(image, image, cv::Size(), 0.6);
  return image;
}

// A red disc of 0.2 m, 2 m below.
inline cv::Mat DiscImage(int shift_px) {
  cv::Mat image(kHeight_px, kWidth_px, CV_8UC3, cv::Scalar(90, 110, 100));
  cv::circle(image, {80 + shift_px % 5, 60}, 8, cv::Scalar(30, 25, 200), cv::FILLED, cv::LINE_AA);
  return image;
}

// A source that hovers: 'frames' drawn images at 100 Hz, each after its pose.
class DrawnCamera : public LiveSource {
 public:
  using Draw = cv::Mat (*)(int index);

  DrawnCamera(int frames, Draw draw, double height_m)
      : frames_(frames), draw_(draw), height_m_(height_m) {}

  std::optional<Event> Next(Duration /*timeout*/) override {
    if (std::exchange(is_pose_given_, !is_pose_given_)) {
      std::this_thread::sleep_for(kFramePeriod);  // the camera's pace
      const int index = static_cast<int>(captured_++);
      return Frame{std::to_string(index), Now(), draw_(index)};
    }
    if (static_cast<int>(captured_) == frames_) return EndOfStream();
    return PoseSample{Now() + kFramePeriod, {Eigen::Quaterniond::Identity(), {0, 0, height_m_}}};
  }

  CaptureCounters counters() const override { return {.captured = captured_}; }

 private:
  int frames_;
  Draw draw_;
  double height_m_;
  bool is_pose_given_ = false;
  std::atomic<std::uint64_t> captured_{0};
};

// Notes all that a session gives to a sink.
class Witness : public ObservationSink {
 public:
  struct Seen {
    std::vector<std::string> frames;
    int found = 0;  // frames with the pattern
    int reports = 0;
    Time end;  // when it was reported that the flight is over
    std::vector<TeamObject> team;
    std::string events;  // one a line
  };

  void Take(const Observation& observation) override {
    const std::lock_guard lock(mutex_);
    seen_.frames.push_back(observation.frame.name);
    const auto* const landing = std::get_if<LandingObservation>(&observation.seen);
    if (landing != nullptr && landing->report.detection) ++seen_.found;
  }
  void Take(const FlightReport& report) override {
    const std::lock_guard lock(mutex_);
    ++seen_.reports;
    if (report.end) seen_.end = Now();
  }
  void Take(const TeamReport& report) override {
    const std::lock_guard lock(mutex_);
    seen_.team = report.objects;
  }
  void Take(const SessionEvent& event) override {
    const std::lock_guard lock(mutex_);
    seen_.events += event.text + "\n";
  }

  Seen seen() const {
    const std::lock_guard lock(mutex_);
    return seen_;
  }

 private:
  mutable std::mutex mutex_;
  Seen seen_;
};

// A drawn camera, as a session takes it.
inline OpenedLiveSource DrawnSource(int frames, DrawnCamera::Draw draw, double height_m) {
  return {.source = std::make_unique<DrawnCamera>(frames, draw, height_m),
          .calibration = SmallCamera(),
          .rate_hz = kRate_hz,
          .has_poses = true};
}

// Options of a session that records on a small disk, and commits often.
inline SessionOptions SmallDisk() {
  SessionOptions options;
  options.flight.recorder.free_space_mb = 0;
  options.flight.recorder.commit_period_s = 0.05;
  return options;
}

}  // namespace kestrel
