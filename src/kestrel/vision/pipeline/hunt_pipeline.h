// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/vision/mapping/object_map.h"
#include "kestrel/vision/objects/object_detector.h"

namespace kestrel {

struct GroundHeight;
class SoughtObject;
struct AssignedObject;

struct HuntPipelineOptions {
  static constexpr int kPoseCapacity = 1000;  // poses that are kept

  ObjectDetectorOptions detector;
  ObjectMapOptions map;
  bool still = false;
  double ground_height_m = 0;
  bool is_ground_flat = true;
  double ground_sigma_m = 0.03;
  double readout_s = 0;
  int track_count = 0;
  double pose_sigma_m = 0.02;
  double attitude_sigma_deg = 0.2;
  double pose_gap_s = 0.5;
  double pose_extrapolation_s = 0;
  double pose_smoothing_s = 0.1;

  static void Visit(auto& self, auto&& visit) {
    visit.Group("detector", self.detector);
    visit.Group("map", self.map);
    visit("still", self.still, "independent frames: no state is carried from one to the next");
    visit("ground_height_m", self.ground_height_m,
          "height of the ground: in the world; by an autopilot's poses above that of the take-off");
    visit("is_ground_flat", self.is_ground_flat,
          "objects that are not on the ground are discarded, where there are poses");
    visit("ground_sigma_m", self.ground_sigma_m, AtLeast(0), "unevenness of the ground");
    visit("readout_s", self.readout_s, Range{0, 1, true, false},
          "time from the first row of a rolling shutter to the last; 0: a global shutter");
    visit("track_count", self.track_count, AtLeast(0),
          "number of objects that are followed, and the rest of the image ignored; 0: the whole "
          "image is searched");
    visit("pose_sigma_m", self.pose_sigma_m, AtLeast(0),
          "error of the navigation's position, standard deviation per axis");
    visit("attitude_sigma_deg", self.attitude_sigma_deg, AtLeast(0),
          "error of the navigation's attitude, standard deviation per axis");
    visit("pose_gap_s", self.pose_gap_s, Between(0, 1e6),
          "longest gap between poses that is interpolated");
    visit("pose_extrapolation_s", self.pose_extrapolation_s, Range{0, 1},
          "longest prediction of the pose beyond the newest one; 0: none");
    visit("pose_smoothing_s", self.pose_smoothing_s, Range{0, 1},
          "time before (and after, if poses are there) over which poses are averaged; 0: none");
    visit.Gone({"pose_capacity", "unmodelled"});
  }
};

// The result of one frame.
struct HuntObservation {
  Time time;  // time of the frame on the images' clock
  ObjectReport report;
  std::optional<RigidTransform> world_from_camera;  // when there is a pose for this time
  std::optional<RigidTransform> camera_from_body;   // as well
  // For each detection, in order: position and covariance in the world (ENU, m), when it has a
  // location and there is a pose. With a rolling shutter, the pose is that of its row.
  std::vector<std::optional<ObjectLocation>> in_world;
  Duration detect_time{};  // time of ObjectDetector::Detect alone, both calls if there were two
};

// Locates the coloured objects of an image in the world. For use by one thread at a time.
class HuntPipeline {
 public:
  // Throws InputError when calibration, model or options are invalid.
  HuntPipeline(const CameraCalibration& calibration, const ObjectModel& model,
               const HuntPipelineOptions& options);
  // Uses a grid that may differ from the model's own.
  HuntPipeline(const CameraCalibration& calibration, const ObjectModel& model,
               const ColorGrid& grid, const HuntPipelineOptions& options);
  ~HuntPipeline();
  HuntPipeline(HuntPipeline&&) noexcept;
  HuntPipeline& operator=(HuntPipeline&&) noexcept;

  // Adds a pose from the navigation, on its clock, later than those before. It may be earlier than
  // the last frame. A frame that arrives before the pose after its time has none, or a predicted
  // one.
  PoseStatus AddPose(const PoseSample& sample);
  // Adds a report of the gimbal on which the calibration has the camera, in the same way.
  PoseStatus AddGimbal(const GimbalSample& sample);

  // Sets the height (m) of the camera above the ground for frames without a pose; nothing when not
  // known. The camera is then assumed to look straight down.
  void SetAltitude(std::optional<double> altitude_m);

  // Counts the height of the ground in the options from this height in the world (m), instead of
  // from 0.
  void SetGroundZero(double height_m);

  // Changes the options and keeps the map and the poses. The options in 'map' and 'unmodelled' and
  // those of the poses keep their old effect. Throws InputError and changes nothing when the
  // options are invalid.
  void ChangeOptions(const HuntPipelineOptions& options);

  // Processes one frame. 'image': CV_8UC3 of the camera's size; 'time': on the images' clock. The
  // result is valid until the next call. Does not throw, and does not allocate once it has warmed
  // up.
  const HuntObservation& Process(const cv::Mat& image, Time time);

  // Seeks an object of this class from now on, see sought(). Near it the images are searched for
  // that one alone (the paper's tracking mode), and completely only where it is not found. Throws
  // InputError when the model has no such class.
  void Seek(const std::string& class_name);
  // As of SoughtObject, which is there.
  void Assign(const AssignedObject& object);
  void Leave(int number);
  // The object that is sought, after the last frame; null: none is.
  const SoughtObject* sought() const;

  const ObjectDetector& detector() const;
  // The objects in the world; empty without poses and with independent frames.
  const ObjectMap& map() const;
  const HuntPipelineOptions& options() const;

  // Returns how much higher the ground is, by the size of the objects, than given (by the options'
  // height with the navigation's poses, or by the altitude); nothing as long as they agree.
  std::optional<GroundHeight> ground_contradiction() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kestrel
