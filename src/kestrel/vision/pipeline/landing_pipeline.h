// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/pipeline/calibration_monitor.h"
#include "kestrel/vision/pipeline/camera_poses.h"
#include "kestrel/vision/pipeline/measurement_noise.h"
#include "kestrel/vision/pipeline/told_contradictions.h"
#include "kestrel/vision/tracking/target_tracker.h"

namespace kestrel {

struct LandingPipelineOptions {
  LandingPatternDetectorOptions detector;
  TargetTrackerOptions tracker;
  MeasurementNoise noise;  // of what the tracker gets, besides the detector's own
  // Frames have nothing to do with each other: no state is carried from one to the next.
  bool still = false;
  // The world position from the camera's altitude (paper, eq. 3) instead of from the pattern's size
  // in the image. Better only where the altitude is known to a few cm and the pattern is small.
  bool position_by_altitude = false;
  // Height of the pattern's face above the world's z = 0. With it the navigation's z becomes the
  // height above the pattern, for the hint and for position_by_altitude. It holds until the
  // detections contradict it: the navigation's z may be an altitude above sea level.
  double target_height_m = 0;
  // The pattern turns with the vehicle: its yaw tells the tracker how the path bends. Switch off
  // where it lies on something that turns by itself.
  bool track_yaw = true;
  // Tell the detector the height above the pattern that the navigation reports. Switch off where
  // the world's z is no height above ground.
  bool altitude_hint = true;
  // Where the pattern is searched for first: within hint_sigma_m (standard deviation per axis, to
  // which the track's own is added) of where the track says that it is. Without poses there is no
  // track: the last position in the camera serves, with an uncertainty that grows by
  // hint_speed_mps, for hint_age_s. Where the pattern is not found there, the whole image is
  // searched.
  double hint_sigma_m = 0.2;
  double hint_speed_mps = 5;
  double hint_age_s = 0.5;
  // How many poses are kept, and the longest gap between two of them that is interpolated.
  int pose_capacity = 1000;
  double pose_gap_s = 0.5;
  // A frame after the newest pose is placed by that pose and its motion, at most so far ahead, less
  // surely the further it is. In a recording every pose is there, and 0 does.
  double pose_extrapolation_s = 0;
  UnmodelledMotion unmodelled;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor.Group("detector", self.detector);
    visitor.Group("tracker", self.tracker);
    visitor.Group("noise", self.noise);
    visitor("still", self.still, "", "frames have nothing to do with each other");
    visitor("position_by_altitude", self.position_by_altitude, "",
            "world position from the altitude instead of from the pattern's size");
    visitor("target_height_m", self.target_height_m, "m",
            "height of the pattern above the world's z = 0");
    visitor("track_yaw", self.track_yaw, "",
            "the pattern turns with the vehicle: its yaw tells how the path bends");
    visitor("altitude_hint", self.altitude_hint, "",
            "tell the detector the height that the navigation reports");
    visitor("hint_sigma_m", self.hint_sigma_m, "m",
            "how far from where it should be the pattern is searched for first");
    visitor("hint_speed_mps", self.hint_speed_mps, "m/s",
            "growth of that with the age of the last detection, where there are no poses");
    visitor("hint_age_s", self.hint_age_s, "s",
            "a detection older than this is no hint, where there are no poses");
    visitor("pose_capacity", self.pose_capacity, "1", "how many poses are kept");
    visitor("pose_gap_s", self.pose_gap_s, "s", "longest gap between poses that is interpolated");
    visitor("pose_extrapolation_s", self.pose_extrapolation_s, "s",
            "how far after the newest pose it is predicted, 0 for not at all");
    visitor.Group("unmodelled", self.unmodelled);
  }
  std::vector<std::string> Validate() const;
};

// How a position in the world was found (paper, section 2.5).
enum class PositionMethod { kSize, kAltitude };
const char* ToString(PositionMethod method);  // "size", "altitude"

// What one frame said.
struct LandingObservation {
  Time time;                                        // of the frame, on the clock of the images
  LandingReport report;                             // the detection in the camera frame, or why not
  std::optional<RigidTransform> world_from_camera;  // when there was a pose for this time
  PoseLookup pose = PoseLookup::kEmpty;             // or why there was none
  PoseUncertainty pose_uncertainty;                 // of a predicted pose
  // With a detection and a pose: the pattern's centre in the world (ENU, m), by what it was found,
  // and the yaw of the pattern, see PatternYaw.
  std::optional<Eigen::Vector3d> center_in_world;
  PositionMethod position_method = PositionMethod::kSize;
  std::optional<double> yaw_in_world;
  // The track, unless every frame is for itself: what became of the detection, and the target at
  // the time of the frame, when that is known.
  std::optional<MeasurementFate> fate;
  TrackState track_state = TrackState::kSearching;
  std::optional<TargetEstimate> target;
  Duration detect_time{};  // of LandingPatternDetector::Detect alone
};

// From an image to where the landing pattern is in the world and will be: pose history, mount and
// clock offset, detector, tracker, whose prediction is the next frame's hint. One thread at a time.
class LandingPipeline {
 public:
  // Throws InputError when the calibration or the options are not valid.
  LandingPipeline(const CameraCalibration& calibration, const LandingPipelineOptions& options);

  // A pose from the navigation, on its clock, later than those before; it may be of a time before
  // the last frame. A frame that comes before the pose after its time has none, or a predicted one.
  PoseStatus AddPose(const PoseSample& sample) { return poses_.Add(sample); }

  // Height (m) of the camera above the pattern, for frames without a pose; nothing: not known.
  void SetAltitude(std::optional<double> altitude_m) { altitude_m_ = altitude_m; }

  // Time (ms) that the search of a frame may take where the options say none; 0: any.
  void LimitSearch(double max_search_ms) { max_search_ms_ = max_search_ms; }

  // Goes on with other options, and keeps the track and the poses: what 'tracker', 'unmodelled' and
  // the options of the poses say stays as it was. Throws InputError, and changes nothing, when they
  // are not valid.
  void ChangeOptions(const LandingPipelineOptions& options);

  // 'image': CV_8UC1 of the camera's size; 'time' on the clock of the images. Does not throw, and
  // does not allocate once it has warmed up.
  LandingObservation Process(const cv::Mat& image, Time time);

  // How what is told of height and attitude contradicts what the detections show.
  const ToldContradictions& contradictions() const { return contradictions_; }

  // What the detections say about the calibration.
  const CalibrationMonitor& calibration_monitor() const { return calibration_monitor_; }

  // The track; its times are those of the frames.
  const TargetTracker& tracker() const { return tracker_; }
  const LandingPatternDetector& detector() const { return detector_; }
  const LandingPipelineOptions& options() const { return options_; }

 private:
  // Where the pattern was seen last, in the camera.
  struct Sighting {
    Time time;
    Eigen::Vector3d center_in_camera;
  };

  void Detect(const cv::Mat& image, LandingObservation* observation);
  ToldView WhatIsTold(const LandingObservation& observation) const;
  double AltitudeExcess() const;
  void AddErrorOfFocalLength(LandingDetection* detection) const;
  void AddTrack(const LandingObservation& observation, LandingHint* hint) const;
  void AddLastSighting(const LandingObservation& observation, LandingHint* hint) const;
  void LocateInWorld(LandingObservation* observation) const;
  TargetMeasurement MeasurementOf(const LandingObservation& observation) const;
  void Track(LandingObservation* observation);
  void Remember(const LandingObservation& observation);

  LandingPipelineOptions options_;
  LandingPatternDetector detector_;
  LandingWorkspace workspace_;
  CameraPoses poses_;
  std::optional<double> altitude_m_;
  TargetTracker tracker_;
  bool is_track_trusted_ = true;  // the last detection was where the track expected it
  std::optional<Sighting> last_;
  int next_step_ = 0;  // where the search of the last frame was given up
  double max_search_ms_ = 0;
  ToldContradictions contradictions_;
  CalibrationMonitor calibration_monitor_;
};

}  // namespace kestrel
