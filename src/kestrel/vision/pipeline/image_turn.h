// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"

namespace kestrel {

// Rotation of a camera from one image to the next: the one with which the gray values agree best
// (Lucas and Kanade 1981), from coarse images to fine ones. The motion of the camera past a scene
// that is near adds to it.
class ImageTurn {
 public:
  // 'may_zoom': the image may also become larger or smaller from one to the next, up to threefold;
  // takes a little longer. Throws InputError when the camera is not valid.
  explicit ImageTurn(const CameraIntrinsics& camera, bool may_zoom = false);

  // Returns the rotation vector (rad, in the camera's frame) from the image before to this one;
  // nothing for the first image, and where no rotation explains the difference.
  // 'image': of the camera's size, CV_8UC1 or CV_8UC3 (BGR).
  std::optional<Eigen::Vector3d> Add(const cv::Mat& image);

  // Returns by which factor the newest image is larger than the one before; after an Add that
  // returned a rotation. 1 unless 'may_zoom'.
  double scale() const { return scale_; }

  // The next image is the first one.
  void Restart() { has_before_ = false; }

 private:
  struct Sample {
    int x, y;
    Eigen::Matrix<float, 2, 3> shift_of_turn;  // px per rad
  };
  struct Level {
    cv::Mat before, now, slope_x, slope_y;  // CV_32FC1
    std::vector<Sample> samples;
  };
  // A rotation vector, how much lighter the image is, and its growth: a factor minus 1.
  using Turn = Eigen::Matrix<float, 5, 1>;

  static Level MakeLevel(const CameraModel& camera, int width_px, int step_px);
  bool Fit(const Level& level, Turn* turn) const;
  bool FitAll(Turn* turn) const;
  bool FitZoom(Turn* turn) const;

  bool may_zoom_;
  double scale_ = 1;
  std::array<Level, 3> levels_;  // the finest first
  cv::Mat gray_, small_;
  bool has_before_ = false;
};

}  // namespace kestrel
