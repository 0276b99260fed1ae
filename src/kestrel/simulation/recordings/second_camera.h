// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/io/recording/euroc/recording_file.h"
#include "kestrel/simulation/recordings/simulated_landing.h"
#include "kestrel/simulation/rendering/flight_camera.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/vehicle/navigation_model.h"

namespace kestrel {

// A second camera on the UAV, with a mount and a clock of its own, and what happens to it.
struct SecondCameraOptions {
  double fov_deg = 0;
  double tilt_deg = 0;
  double rate_hz = 30;
  std::string fault = "none";
  double fault_at_s = 5;

  static void Visit(auto& self, auto&& visit) {
    visit("fov_deg", self.fov_deg, Range{0, 150}, "field of view of a second camera; 0: none");
    visit("tilt_deg", self.tilt_deg, Range{0, 120},
          "where it looks: 0 down, 45 between down and ahead");
    visit("rate_hz", self.rate_hz, Range{0.1, 1000}, "images per second");
    visit("fault", self.fault, OneOf{{"none", "dead", "frozen", "late", "mount"}},
          "what happens to it: no more images, the same image, images stamped 0.3 s late, a mount "
          "turned by 5 degrees");
    visit("fault_at_s", self.fault_at_s, Range{0, 1e5}, "when");
  }

  bool is_there() const { return fov_deg > 0; }
};

// Returns the nominal calibration of a second camera, 752x480 pixels, beside the first one.
CameraCalibration SecondCalibration(double fov_deg, double tilt_deg);

// The second camera of a flight. Thread-safe.
class SecondCamera {
 public:
  // 'landing': the flight with its first camera; outlives this. 'options': those of the flight.
  SecondCamera(const SecondCameraOptions& options, const FlightRecordingOptions& flight,
               const SimulatedLanding& landing, const Motion& world_from_uav, std::uint64_t seed);

  // Times of its images on their own clock.
  const std::vector<Time>& times() const { return times_; }
  cv::Mat Image(std::size_t index) const;

  // Lines for scene.yaml.
  std::string SceneText() const;
  // cam1/sensor.yaml and data.csv, and landing_pattern0/cam1.csv: the truth of its images.
  std::vector<RecordingFile> Files() const;

 private:
  double TimeInFlight(std::size_t index) const;

  SecondCameraOptions options_;
  std::uint64_t seed_;
  const SimulatedLanding& landing_;
  CameraCalibration nominal_;
  NavigationErrors errors_;
  FlightCamera camera_;
  std::vector<double> times_s_;  // since the flight began, by the stamps
  std::vector<Time> times_;
};

}  // namespace kestrel
