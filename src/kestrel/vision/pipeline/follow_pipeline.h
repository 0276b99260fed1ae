// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/vision/region/region_tracker.h"
#include "kestrel/vision/tracking/target_tracker.h"

namespace kestrel {

struct FollowPipelineOptions {
  static constexpr int kPoseCapacity = 1000;  // poses that are kept

  double ground_height_m = 0;
  double ground_sigma_m = 0.5;
  double pose_extrapolation_s = 0;  // longest prediction of the pose; a flight sets it

  static void Visit(auto& self, auto&& visit) {
    visit(
        "ground_height_m", self.ground_height_m, Between(-1e5, 1e5),
        "height of the ground under what is followed: in the world; by an autopilot's poses above "
        "that of the take-off");
    visit("ground_sigma_m", self.ground_sigma_m, Range{0, 100, true, false},
          "error of that height, standard deviation");
    visit.Gone({"max_speed_mps"});
  }

  TargetTrackerOptions Tracker() const;  // for the motion in the world
};

// A place on the ground, in the world (ENU, m).
struct PlaceOnGround {
  Eigen::Vector3d position;
  Eigen::Matrix3d covariance;  // m^2, of all errors
};

// The result of one frame.
struct FollowObservation {
  Time time;                           // when the frame was taken, on the images' clock
  std::optional<RegionReport> region;  // nothing before something was marked
  std::optional<RigidTransform> world_from_camera;  // when there is a pose for this time
  std::optional<RigidTransform> camera_from_body;   // as well
  // With a pose, while the region is seen: the direction to it in the world (ENU), of length 1.
  std::optional<Eigen::Vector3d> bearing;
  // Where that meets the ground; nothing near and above the horizon.
  std::optional<PlaceOnGround> place;
  // The track of the places: what became of this one, and the target at the time of the frame.
  std::optional<MeasurementFate> fate;
  TrackState track_state = TrackState::kSearching;
  std::optional<TargetEstimate> target;
  Duration detect_time{};  // time of RegionTracker::Mark or Track alone

  // Returns the distance from the camera to the target; nothing when one of them is not known.
  std::optional<double> distance_m() const;
};

// Follows what a person has marked in an image, and locates it on the ground: region tracker, pose
// history, level ground, and target tracker, whose prediction is the next frame's hint. For use by
// one thread at a time.
class FollowPipeline {
 public:
  // Throws InputError when calibration or options are invalid.
  FollowPipeline(const CameraCalibration& calibration, const FollowPipelineOptions& options);
  ~FollowPipeline();
  FollowPipeline(FollowPipeline&&) noexcept;
  FollowPipeline& operator=(FollowPipeline&&) noexcept;

  // Adds a pose from the navigation, on its clock, later than those before. A frame that arrives
  // before the pose after its time has none, or a predicted one.
  PoseStatus AddPose(const PoseSample& sample);
  // Adds a report of the gimbal on which the calibration has the camera, in the same way.
  PoseStatus AddGimbal(const GimbalSample& sample);

  // Changes the options, and keeps poses and mark. Throws InputError and changes nothing when they
  // are invalid.
  void ChangeOptions(const FollowPipelineOptions& options);

  // Counts the height of the ground in the options from this height in the world (m), instead of
  // from 0.
  void SetGroundZero(double height_m);

  // Processes a frame in which a person has marked a region, in place of what was followed before.
  // 'image', 'box_px': as RegionTracker::Mark, which throws InputError; 'time': on the clock of the
  // images.
  FollowObservation Mark(const cv::Mat& image, Time time, const cv::Rect2d& box_px);

  // Follows nothing until the next mark.
  void Unmark();

  // Processes a later frame. Does not throw, and does not allocate once it has warmed up.
  FollowObservation Process(const cv::Mat& image, Time time);

  const TargetTracker& tracker() const;
  const FollowPipelineOptions& options() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kestrel
