// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/base/options.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/camera/exposure_controller.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/flight/guidance/landing_guidance.h"
#include "kestrel/simulation/recordings/simulated_landing.h"
#include "kestrel/simulation/recordings/touchdown_result.h"
#include "kestrel/simulation/scene/landing_scene.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/vehicle/flown_path.h"
#include "kestrel/simulation/vehicle/multicopter.h"
#include "kestrel/simulation/vehicle/wind.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// Start of the UAV, conditions of a touchdown, and delay of the vision.
struct TouchdownOptions {
  double start_altitude_m = 10;
  double start_distance_m = 20;
  bool starts_behind = false;
  double pass_min_s = 4;
  double pass_max_s = 8;
  double processing_delay_s = 0.06;
  double leg_m = 0.35;
  double feet_radius_m = 0.25;
  double deck_m = 1.5;
  double max_slip_mps = 1.5;
  double max_sink_mps = 2;

  static void Visit(auto& self, auto&& visit) {
    visit("start_altitude_m", self.start_altitude_m, Range{1, 100}, "height at the start");
    visit("start_distance_m", self.start_distance_m, Range{0, 500},
          "distance from the start to the place where the vehicle passes");
    visit("starts_behind", self.starts_behind,
          "the UAV starts so far behind the vehicle instead, as fast as it drives");
    visit("pass_min_s", self.pass_min_s, Range{0, 1000}, "earliest time at which it passes there");
    visit("pass_max_s", self.pass_max_s, "latest time at which it passes there");
    visit("processing_delay_s", self.processing_delay_s, Range{0.02, 1},
          "delay from the middle of an exposure to the result");
    visit("leg_m", self.leg_m, Range{0.05, 2}, "length from the body's origin down to its feet");
    visit("feet_radius_m", self.feet_radius_m, Range{0, 2}, "room that the feet need");
    visit("deck_m", self.deck_m, Range{0, 100}, "side of the deck under a smaller board");
    visit("max_slip_mps", self.max_slip_mps, Range{0.1, 10}, "speed at which it stays there");
    visit("max_sink_mps", self.max_sink_mps, Range{0.1, 10}, "sink rate that the legs stand");
  }
  std::vector<std::string> Validate() const;
};

// A simulated UAV that lands on a vehicle by the results of the pipeline.
struct TouchdownSimulationOptions : LandingSceneOptions {
  TouchdownSimulationOptions();

  TouchdownOptions touchdown;
  FlightRecordingOptions recording;
  MulticopterOptions multicopter;
  WindOptions wind;
  GuidanceOptions guidance;
  TargetTrackerOptions tracker;
  ExposureOptions exposure;

  static void Visit(auto& self, auto&& visit) {
    visit.Group(self.recording);
    visit.Group("touchdown", self.touchdown);
    visit.Group("multicopter", self.multicopter);
    visit.Group("wind", self.wind);
    visit.Group("guidance", self.guidance);
    visit.Group("tracker", self.tracker);
    visit.Group("exposure", self.exposure);
    LandingSceneOptions::Visit(self, visit);
  }
  std::vector<std::string> Validate() const;
};

// A closed loop: the UAV flies by the track, the track comes from the pipeline, the pipeline
// receives the delayed rendered images and the poses reported by the navigation, and the images
// show the view from the place to which the flight has brought the UAV. The truth is used only for
// rendering and for the result. The same arguments give the same flight.
class TouchdownSimulation {
 public:
  // 'camera' has a mount; the pipeline knows it and the drawn clock offset. Throws InputError when
  // options are not valid.
  TouchdownSimulation(const TouchdownSimulationOptions& options, const CameraCalibration& camera,
                      std::uint64_t seed);
  TouchdownSimulation(const TouchdownSimulation&) =
      delete;  // the camera refers to the path that is in it
  TouchdownSimulation& operator=(const TouchdownSimulation&) = delete;

  // Called with every image and the pipeline's result for it, in order; returns whether to go on.
  using FrameSink = std::function<bool(const cv::Mat& image, const LandingObservation& observation,
                                       const LandingPipeline& pipeline)>;

  // Flies until touchdown or the last image. Nothing when 'sink' stopped it. Call it once only.
  std::optional<TouchdownResult> Fly(const FrameSink& sink);

  // Texts of a recording: scene.yaml, and after the flight the other files.
  std::string SceneText() const { return landing_.SceneText("touchdown", PrintOptions(options_)); }
  std::vector<RecordingFile> Files() const { return landing_.Files(); }

 private:
  struct Start {
    Eigen::Vector3d position;
    double heading;         // rad, towards the place
    Eigen::Vector2d place;  // where the vehicle will pass
    Eigen::Vector3d velocity{0, 0, 0};
  };
  struct TakenImage {
    cv::Mat image;
    Time time;
  };

  Start DrawStart() const;
  Start StartBehind() const;
  void ReportPoses(double time_s);
  void TakeImage(double time_s);
  bool ProcessImages(double until_s, const FrameSink& sink, TouchdownResult* result);
  SetPoint Guide(double time_s);
  bool HasEnded(double time_s, TouchdownResult* result) const;
  std::optional<double> HeadingError(double time_s) const;
  TouchdownOutcome OutcomeOf(const Eigen::Vector3d& feet_on_board,
                             const TouchdownResult& result) const;
  void RideOn(double time_s);
  Eigen::Vector3d FeetAt(double time_s) const;

  TouchdownSimulationOptions options_;
  std::uint64_t seed_;
  FlownPath path_;
  SimulatedLanding landing_;
  Path wind_;
  Start start_;
  Multicopter multicopter_;
  NavigationSensor navigation_;
  PoseSample newest_pose_;
  int poses_ = 0;  // number of reported poses
  Duration clock_offset_;
  LandingPipeline pipeline_;
  LandingGuidance guidance_;
  ExposureController exposure_;
  std::deque<double> exposures_s_;  // exposures of the next images
  cv::Rect pattern_area_;           // in the newest processed image
  std::deque<TakenImage> images_;   // taken, not yet processed
  std::size_t next_image_ = 0;
  std::optional<Time> last_seen_;  // time of the newest image that showed the target
};

}  // namespace kestrel
