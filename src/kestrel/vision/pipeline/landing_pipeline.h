// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/core/poses/zoom_history.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/pipeline/camera_state.h"
#include "kestrel/vision/pipeline/measurement_noise.h"
#include "kestrel/vision/target/target_detector.h"
#include "kestrel/vision/targets/make_target_detector.h"
#include "kestrel/vision/tracking/target_tracker.h"

namespace kestrel {

class CalibrationMonitor;
class InputContradictions;

struct LandingPipelineOptions {
  // Growth of the hint's uncertainty with the age of the last detection, where there are no poses.
  static constexpr double kHintSpeed_mps = 5;
  static constexpr int kPoseCapacity = 1000;  // poses that are kept

  TargetOptions target;
  LandingPatternDetectorOptions detector;
  TargetTrackerOptions tracker;
  MeasurementNoise noise;
  bool still = false;
  bool position_by_altitude = false;
  double target_height_m = 0;
  bool track_yaw = true;
  bool altitude_hint = true;
  double hint_sigma_m = 0.2;
  double hint_age_s = 0.5;
  double pose_gap_s = 0.5;
  double pose_extrapolation_s = 0;

  static void Visit(auto& self, auto&& visit) {
    visit.Group("target", self.target);
    visit.Group("detector", self.detector);
    visit.Group("tracker", self.tracker);
    visit.Group("noise", self.noise);
    visit("still", self.still, "independent frames: no state is carried from one to the next");
    visit("position_by_altitude", self.position_by_altitude,
          "world position from the altitude instead of from the pattern's size");
    visit("target_height_m", self.target_height_m, "height of the pattern above the world's z = 0");
    visit("track_yaw", self.track_yaw,
          "the pattern turns with the vehicle, so that its yaw shows how the path bends");
    visit("altitude_hint", self.altitude_hint,
          "the detector gets the height that the navigation reports");
    visit("hint_sigma_m", self.hint_sigma_m, MoreThan(0),
          "error of the predicted position that the first search covers, in addition to the "
          "track's, standard deviation per axis");
    visit("hint_age_s", self.hint_age_s, AtLeast(0),
          "largest age of a detection that serves as a hint, where there are no poses");
    visit("pose_gap_s", self.pose_gap_s, Between(0, 1e6),
          "longest gap between poses that is interpolated");
    visit("pose_extrapolation_s", self.pose_extrapolation_s, Range{0, 1},
          "longest prediction of the pose beyond the newest one; 0: none");
    visit.Gone({"hint_speed_mps", "pose_capacity", "unmodelled"});
  }
};

// Method by which a position in the world was found (paper, section 2.5).
enum class PositionMethod { kSize, kAltitude };
const char* ToString(PositionMethod method);  // "size", "altitude"

// Another tag of the target's family than the one that is looked for.
struct OtherTag {
  std::string_view family;  // static text
  int wanted_id;
  int id;
  std::size_t frames;  // in which it was read, until now
};
// "no tag36h11 8; tag36h11 7 was seen in 25 frames"
std::string InWords(const OtherTag& other);

// The result of one frame.
struct LandingObservation {
  Time time;            // time of the frame on the images' clock; of several, the first camera's
  TargetReport report;  // the detection in the camera frame, or the reason of a miss
  // With a miss, as long as the target was never found: another tag that was read.
  std::optional<OtherTag> other_tag = {};
  std::optional<RigidTransform> world_from_camera;  // when there is a pose for this time
  // The mount; on a gimbal only when there is a pose for this time.
  std::optional<RigidTransform> camera_from_body;
  PoseLookup pose = PoseLookup::kEmpty;  // whether there is a pose, or why not
  PoseUncertainty pose_uncertainty;      // uncertainty of a predicted pose
  // With a detection and a pose: the pattern's centre in the world (ENU, m), the method, and the
  // yaw of the pattern, see PatternYaw, if it has one.
  std::optional<Eigen::Vector3d> center_in_world;
  PositionMethod position_method = PositionMethod::kSize;
  std::optional<double> yaw_in_world;
  // The track, unless frames are independent: what became of the detection, and the target at the
  // time of the frame, when it is known.
  std::optional<MeasurementFate> fate;
  TrackState track_state = TrackState::kSearching;
  std::optional<TargetEstimate> target;
  Duration detect_time{};  // time of TargetDetector::Detect alone
  std::size_t camera = 0;  // index of the camera among the pipeline's
  // The lens of a camera that zooms, in this frame; null where it moved or is not known, so that
  // the frame was not searched.
  std::shared_ptr<const CameraModel> zoomed_lens = nullptr;
  bool is_zooming = false;  // it was not searched therefore
};

// Returns in words why the target was not found in a frame: that another tag was, or else as
// MissInWords(TargetReport).
std::string MissInWords(const LandingObservation& observation);

// Locates the pad of an image in the world and predicts it: pose history, mount and clock offset,
// detector, and tracker, whose prediction is the next frame's hint. For use by one thread at a
// time.
class LandingPipeline {
 public:
  // Part above the horizon that is searched for a pad, with an attitude that is exact.
  static constexpr double kSkyMargin_rad = Radians(5);

  // Throws InputError when calibration or options are invalid.
  LandingPipeline(const CameraCalibration& calibration, const LandingPipelineOptions& options);
  // The same for a detector of one's own, of this calibration's camera. The options 'target' and
  // 'detector' have no effect.
  LandingPipeline(const CameraCalibration& calibration,
                  std::unique_ptr<const TargetDetector> detector,
                  const LandingPipelineOptions& options);
  // Several cameras, at least one, whose images together make one track. They need not be
  // synchronised. A camera that repeats its image, sends none, or contradicts the others is left
  // out, see camera_state().
  LandingPipeline(std::span<const CameraCalibration> cameras,
                  const LandingPipelineOptions& options);
  // The same with detectors of one's own, one for each camera.
  LandingPipeline(std::span<const CameraCalibration> cameras,
                  std::vector<std::unique_ptr<const TargetDetector>> detectors,
                  const LandingPipelineOptions& options);
  ~LandingPipeline();
  LandingPipeline(LandingPipeline&&) noexcept;
  LandingPipeline& operator=(LandingPipeline&&) noexcept;

  // Adds a pose from the navigation, on its clock, later than those before. It may be earlier than
  // the last frame. A frame that arrives before the pose after its time has none, or a predicted
  // one.
  PoseStatus AddPose(const PoseSample& sample);
  // Adds a report of the gimbal on which the calibration has the camera, in the same way. All
  // cameras on a gimbal are on the same one.
  PoseStatus AddGimbal(const GimbalSample& sample);
  // Adds a report of the zoom that the calibration has, in the same way.
  PoseStatus AddZoom(const ZoomSample& sample);

  // Sets the height (m) of the camera above the pattern for frames without a pose; nothing when not
  // known.
  void SetAltitude(std::optional<double> altitude_m);

  // Sets the time limit (ms) of a frame's search where the options set none; 0: no limit.
  void LimitSearch(double max_search_ms);

  // Changes the options and keeps the track and the poses. The options in 'tracker' and
  // 'unmodelled' and those of the poses keep their old effect. Throws InputError and changes
  // nothing when the options are invalid.
  void ChangeOptions(const LandingPipelineOptions& options);

  // Processes one frame of a camera, by its index. 'image': CV_8UC1 of the camera's size; 'time':
  // on the clock of its images. Does not throw, and does not allocate once it has warmed up, except
  // for the first frame after a zoom has come to rest, which takes some milliseconds more.
  LandingObservation Process(const cv::Mat& image, Time time, std::size_t camera = 0);

  std::size_t camera_count() const;
  // Whether a camera contributes to the track, or why not. Always, where it is the only one.
  const CameraState& camera_state(std::size_t camera) const;

  // Contradictions between the detections of a camera and the given height and attitude.
  const InputContradictions& contradictions(std::size_t camera = 0) const;

  // Evidence of the detections about the calibration of a camera.
  const CalibrationMonitor& calibration_monitor(std::size_t camera = 0) const;

  // The track. Its times are those of the frames; of several cameras, those of the first one's
  // clock.
  const TargetTracker& tracker() const;
  const TargetDetector& detector(std::size_t camera = 0) const;
  const LandingPipelineOptions& options() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kestrel
