// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/target/target_detection.h"

namespace kestrel {

// Points of a pad, their places in the image and gray values there. Memory that is kept.
class PadSamples {
 public:
  void Reserve(std::size_t most);

  void Clear() { count_ = 0; }
  // Adds a point in the camera frame. There must be room.
  void Add(const Eigen::Vector3d& point_in_camera);

  // Computes the places of all points; NaN where the lens does not see them.
  void Project(const CameraModel& camera);
  // Has the points at 'places' on a pad in this pose instead, and computes their places in the
  // image.
  void Place(const CameraModel& camera, const RigidTransform& camera_from_pad,
             std::span<const Eigen::Vector2d> places);
  // Reads the gray values at the places, moved by (dx, dy) px; negative outside of the image.
  std::span<const float> Read(const cv::Mat& image, float dx = 0, float dy = 0);
  // The same where the points are the cells of a grid, row by row, of 'cell_px' each. Wide cells
  // are read by a median over their middle. Small cells are sharpened, because lens and pixels mix
  // them with their neighbours.
  std::span<const float> ReadCells(const cv::Mat& image, int grid_width, double cell_px);

  std::size_t count() const { return count_; }
  float u(std::size_t i) const { return u_[i]; }
  float v(std::size_t i) const { return v_[i]; }

 private:
  void TakeMedians(const cv::Mat& image, std::size_t grid_width);

  std::size_t count_ = 0;
  std::vector<float> x_, y_, z_, u_, v_, moved_u_, moved_v_, gray_;
};

// Meaning of a sample of a print with less contrast than usual, but clear contrast: a white cell
// darker than the white around it, and lighter than the black. On a pad that is followed it is in a
// shadow; in a search another print is as likely.
enum class DimSample { kWrong, kUnknown };
inline DimSample DimSampleIn(DetectionMethod method) {
  return method == DetectionMethod::kFollowed ? DimSample::kUnknown : DimSample::kWrong;
}

}  // namespace kestrel
