// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/evaluation/scene_truth.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"

namespace kestrel {

// The truth of a recording, whatever is searched for in it: images, lens, mount, flight, scene. All
// times are on the clock of the images.
class FlightTruth {
 public:
  // 'recording': a folder in the EuRoC layout with state_groundtruth_estimate0; scene.yaml may be
  // absent. Throws InputError when a file is missing or not valid.
  explicit FlightTruth(const std::string& recording);

  const std::string& root() const { return root_; }  // the folder of cam0
  const std::vector<Time>& frames() const { return frames_; }
  const CameraModel& camera() const { return camera_; }
  const SceneTruth& scene() const { return scene_; }

  // Throws InputError when there is no image with this time; 'row' names the source of the time.
  void RequireFrame(Time time, const std::string& row) const;

  // True poses; nothing outside of the ground truth and in its gaps.
  std::optional<RigidTransform> WorldFromBody(Time time) const { return poses_.Lookup(time); }
  std::optional<RigidTransform> WorldFromCamera(Time time) const;  // with the mount's error

 private:
  std::string root_;
  std::vector<Time> frames_;
  SceneTruth scene_;
  CameraModel camera_;
  CameraCalibration calibration_;  // nominal
  PoseHistory poses_;
  GimbalHistory gimbal_;  // empty where the calibration has none
};

}  // namespace kestrel
