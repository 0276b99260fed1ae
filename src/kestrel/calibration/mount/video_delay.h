// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/vision/pipeline/camera_poses.h"

namespace kestrel {

// t_nav = t_image + offset_s.
struct ClockEstimate {
  double offset_s = 0;
  double sigma_s = 0;  // standard deviation
};

// The clock offset of a camera from how it turns: the rotations of its images, see ImageTurn,
// correlated with those of the attitudes that the navigation reports, and those of its gimbal.
// Needs no target. Rotations and motion past a near scene that are in proportion to those reported
// explain the images; their factors are unknowns, so that lens, mount and height need not be exact.
class VideoDelay {
 public:
  static constexpr double kWindow_s = 20;  // of the newest images that count
  static constexpr double kLatest_s = 1;   // largest delay of images that is found
  static constexpr double kEarliest_s = 0.1;

  // 'calibration': has a mount, or its gimbal; its clock offset has no effect.
  explicit VideoDelay(const CameraCalibration& calibration);

  void Add(const PoseSample& pose);
  void Add(const GimbalSample& report);
  // Takes the rotation vector (rad, camera frame) of the camera from one image to the next, whose
  // times are on the images' clock.
  void Add(Time from, Time to, const Eigen::Vector3d& turn);
  // Forgets the images before 'begin', whose offset may be another one.
  void ForgetBefore(Time begin);

  // Returns the offset by the images since 'begin'; nothing as long as the camera has not turned
  // enough to show it.
  std::optional<ClockEstimate> Estimate(Time begin = Time::min()) const;

 private:
  struct Turn {
    Time from;
    Time to;
    Eigen::Vector3d rotation;
  };
  // Sums of the increments of the camera's rotation and of its motion, in the camera's frame, up to
  // an instant of the grid.
  using Path = Eigen::Matrix<double, 6, 1>;

  void Sample();
  bool IsCovered(const Turn& turn) const;
  Path PathAt(Time time) const;
  std::optional<ClockEstimate> Fit(const std::vector<Turn>& turns) const;
  std::vector<double> Likelihoods(const std::vector<Turn>& turns) const;

  CameraPoses poses_;
  bool has_gimbal_;
  std::optional<Time> newest_pose_;
  std::optional<Time> newest_report_;
  std::optional<CameraPose> last_;  // at the newest instant of the grid
  Time grid_begin_;
  std::deque<Path> grid_;
  std::deque<Turn> turns_;
};

}  // namespace kestrel
