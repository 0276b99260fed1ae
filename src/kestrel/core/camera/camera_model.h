// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/projection_kernel.h"

namespace kestrel {

enum class ProjectionStatus {
  kOk,            // inside the image
  kOutsideImage,  // the pixel is right, but outside of the image
  kOutsideModel,  // the lens model does not cover this ray or pixel; outputs are not written
};

enum class DistortionModel {
  kNone,              // undistorted pinhole
  kRadialTangential,  // Brown-Conrady: k1 k2 p1 p2 [k3 [k4 k5 k6]] (OpenCV's order)
  kEquidistant,       // Kannala-Brandt, OpenCV "fisheye", Kalibr "equidistant": k1 k2 k3 k4
};

// The lens and the image size of a calibration file.
struct CameraIntrinsics {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0;
  double fy_px = 0;
  double cx_px = 0;  // integer coordinate: centre of a pixel
  double cy_px = 0;
  DistortionModel distortion_model = DistortionModel::kNone;
  std::vector<double> distortion;  // 0, 4, 5 or 8 coefficients, depending on the model

  // Returns every violation in words (size, focal length, principal point, NaN, number of
  // coefficients); empty when the calibration is valid.
  std::vector<std::string> Validate() const;
};

// The size of an image differs from the calibration's.
class ImageSizeError : public InputError {
 public:
  using InputError::InputError;
};

// Throws ImageSizeError when the size of an image differs from the calibration's. 'image': its name
// in the message.
void CheckImageSize(const CameraIntrinsics& camera, int width_px, int height_px,
                    const std::string& image);

// Projects points in the camera frame (x right, y down, z along the optical axis) to pixels and
// pixels to rays. Immutable, thread-safe; Project and Unproject neither allocate nor throw.
class CameraModel {
 public:
  // Throws InputError with all violations of Validate().
  explicit CameraModel(const CameraIntrinsics& intrinsics);

  // Projects a point. 'point_in_camera' may have any length. It may lie behind the image plane when
  // the lens sees past 90 degrees. Writes 'd_pixel_d_point' (2x3) when given.
  ProjectionStatus Project(const Eigen::Vector3d& point_in_camera, Eigen::Vector2d* pixel,
                           Eigen::Matrix<double, 2, 3>* d_pixel_d_point = nullptr) const;

  // Projects 'count' points at once, in single precision (errors: pixel 1e-3 px, derivative 1e-4).
  // Pixel and derivative are NaN where the lens model does not cover the point. 'points': columns
  // of x, y and z; 'd_pixel_d_point': columns, row by row. Outputs must not overlap the points.
  void ProjectMany(const std::array<const float*, 3>& points, std::size_t count, float* x_px,
                   float* y_px, const std::array<float*, 6>* d_pixel_d_point = nullptr) const {
    ProjectPoints(kernel_, points, count, x_px, y_px, d_pixel_d_point);
  }

  // Returns the unit ray through 'pixel': the exact inverse of Project (Newton, to 1e-12 rad as
  // long as the pixel still moves with the angle) up to max_angle(). Pixels outside of the image
  // are valid as far as the model reaches.
  ProjectionStatus Unproject(const Eigen::Vector2d& pixel, Eigen::Vector3d* ray_in_camera) const;

  // Largest angle (rad) between a ray and the optical axis for which the model is monotonic, hence
  // invertible, in every direction: at most pi, and for the pinhole kinds atan(1000) = 89.94 deg.
  double max_angle() const { return max_angle_; }
  const CameraIntrinsics& intrinsics() const { return intrinsics_; }
  int width_px() const { return intrinsics_.width_px; }
  int height_px() const { return intrinsics_.height_px; }

 private:
  ProjectionStatus InImage(const Eigen::Vector2d& pixel) const;
  ProjectionStatus ProjectEquidistant(const Eigen::Vector3d& point, Eigen::Vector2d* pixel,
                                      Eigen::Matrix<double, 2, 3>* jacobian) const;
  ProjectionStatus ProjectPinhole(const Eigen::Vector3d& point, Eigen::Vector2d* pixel,
                                  Eigen::Matrix<double, 2, 3>* jacobian) const;
  bool UnprojectEquidistant(const Eigen::Vector2d& distorted, Eigen::Vector3d* ray) const;
  bool UnprojectPinhole(const Eigen::Vector2d& distorted, Eigen::Vector3d* ray) const;

  CameraIntrinsics intrinsics_;
  std::array<double, 8> k_{};  // intrinsics_.distortion, padded with zeros
  bool is_distorted_ = false;  // any coefficient is not zero
  double max_angle_ = 0;
  double max_tangent_ = 0;  // pinhole kinds: tan(max_angle_)
  double max_radius_ = 0;   // distorted radius at max_angle_ by the radial part, focal length 1
  ProjectionKernel kernel_{};
};

}  // namespace kestrel
