// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/simulation/recordings/recording_plan.h"
#include "kestrel/simulation/recordings/zooming_camera.h"
#include "kestrel/simulation/rendering/flight_camera.h"
#include "kestrel/simulation/scene/drawing.h"
#include "kestrel/simulation/scene/light_options.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/vehicle/gimbal_model.h"
#include "kestrel/simulation/vehicle/navigation_model.h"
#include "kestrel/simulation/vehicle/zoom_model.h"

namespace kestrel {

// Options of every flight, whatever is below it.
struct FlightRecordingOptions {
  int frames = 300;
  double rate_hz = 30;
  NavigationOptions navigation;
  GimbalOptions gimbal;
  ZoomOptions zoom;
  LensViewOptions lens;
  ShutterOptions shutter;
  SensorOptions sensor;

  static void Visit(auto& self, auto&& visit) {
    visit("frames", self.frames, Range{1, 1e6}, "number of images");
    visit("rate_hz", self.rate_hz, Range{0.1, 1000}, "images per second");
    visit.Group("navigation", self.navigation);
    visit.Group("gimbal", self.gimbal);
    visit.Group("zoom", self.zoom);
    visit.Group("lens", self.lens);
    visit.Group("shutter", self.shutter);
    visit.Group("sensor", self.sensor);
  }

  double duration_s() const { return frames / rate_hz; }
};

// For Validate() of flights whose task takes no camera that zooms: adds a violation.
void RequireFixedLens(const ZoomOptions& zoom, std::vector<std::string>* violations);

// A flight through a world, with a camera and all errors of its navigation. Thread-safe.
class SimulatedFlight {
 public:
  // 'camera' has a mount, the nominal one; 'airframe' is in front of the lens. A gimbal looks at
  // 'target'.
  SimulatedFlight(const FlightRecordingOptions& options, const CameraCalibration& camera,
                  const Drawing& airframe, World world, Motion world_from_body, const Path& target,
                  std::uint64_t seed);
  SimulatedFlight(const SimulatedFlight&) = delete;  // the camera refers to the world in it
  SimulatedFlight& operator=(const SimulatedFlight&) = delete;

  // The camera with its lens at a time, which zooms if the options have it so.
  std::shared_ptr<const FlightCamera> CameraAt(double time_s) const { return camera_->At(time_s); }
  const World& world() const { return world_; }
  const NavigationErrors& errors() const { return errors_; }
  const std::vector<double>& times_s() const { return times_s_; }  // image times

  // 'gain' multiplies the light, in addition to the varying gain of the options.
  cv::Mat Image(std::size_t index, double gain = 1) const;

  // Leaves out the images from 'index' on: the flight has ended.
  void EndBefore(std::size_t index);

  // Returns the navigation before its first report, which is that of 'begin_s'.
  NavigationSensor navigation() const;
  double begin_s() const;

  // Returns the part of scene.yaml that all flights share; further lines may follow.
  std::string SceneText(const std::string& kind) const;

  // cam0/sensor.yaml, nav0, gimbal0 and zoom0 if there are any, and state_groundtruth_estimate0.
  std::vector<RecordingFile> Files() const;

 private:
  void AddGimbal(std::vector<RecordingFile>* files) const;
  void AddZoom(std::vector<RecordingFile>* files) const;

  FlightRecordingOptions options_;
  CameraCalibration nominal_;
  World world_;
  Motion world_from_body_;
  std::uint64_t seed_;
  NavigationErrors errors_;
  std::vector<double> times_s_;
  std::function<double(double time_s)> gain_;
  std::shared_ptr<const SimulatedGimbal> gimbal_;  // null: the camera is fixed to the body
  std::unique_ptr<const ZoomingCamera> camera_;
};

}  // namespace kestrel
