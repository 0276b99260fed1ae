// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/target/seen_print.h"

namespace kestrel {

// Maps the plane of a print to the image: the projection through the lens under a pose, plus a
// displacement, a polynomial of low order. The displacement absorbs the errors of calibration,
// flatness of the sheet and shutter.
class PlaneWarp {
 public:
  static constexpr int kDegree = 3;
  static constexpr int kTerms = 8;
  using Terms = Eigen::Matrix<double, kTerms, 1>;
  using Coefficients = Eigen::Matrix<double, 2, kTerms>;  // px

  // Starts without a displacement. 'radius_m': unit of length of the polynomial, the radius of the
  // area it is used for. 'camera' must outlive this.
  PlaneWarp(const CameraModel& camera, const RigidTransform& camera_from_target, double radius_m)
      : camera_(camera),
        pose_(camera_from_target),
        plane_(camera_from_target.rotation.toRotationMatrix().leftCols<2>()),
        radius_m_(radius_m) {}

  // Projects a point of the plane (m) to its pixel and the derivative; false when the lens does not
  // show it.
  bool Project(const Eigen::Vector2d& point, Eigen::Vector2d* pixel,
               Eigen::Matrix2d* d_pixel_d_point = nullptr) const;

  // The same for 'count' points at once, in single precision; NaN where the lens does not show a
  // point. 'd_pixel_d_point': columns, row by row. Outputs must not overlap the points.
  void ProjectMany(const float* x_m, const float* y_m, std::size_t count, float* x_px, float* y_px,
                   const std::array<float*, 4>* d_pixel_d_point = nullptr) const;

  // Returns the monomials at a point (m), by rising degree.
  Terms TermsAt(const Eigen::Vector2d& point) const;
  static int DegreeOf(int term);

  double radius_m() const { return radius_m_; }
  const RigidTransform& pose() const { return pose_; }
  const Coefficients& displacement() const { return displacement_; }
  void Displace(const Coefficients& more) { displacement_ += more; }

  // Evaluates the polynomial with coefficients 'c' at a point in units of the radius; px.
  static float Displacement(const std::array<float, kTerms>& c, float x, float y) {
    return c[0] + x * (c[1] + c[3] * x + c[4] * y) + y * (c[2] + c[5] * y) +
           (x * x + y * y) * (c[6] * x + c[7] * y);
  }
  static std::array<float, kTerms> AxisOf(const Coefficients& coefficients, int axis) {
    std::array<float, kTerms> of_axis;
    for (int i = 0; i < kTerms; ++i) of_axis[i] = static_cast<float>(coefficients(axis, i));
    return of_axis;
  }

 private:
  const CameraModel& camera_;
  RigidTransform pose_;
  Eigen::Matrix<double, 3, 2> plane_;
  double radius_m_;
  Coefficients displacement_ = Coefficients::Zero();
};

inline PlaneWarp SeenPrint::Warp(const CameraModel& camera) const {
  PlaneWarp warp(camera, near_pose, radius_m);
  warp.Displace(displacement_px);
  return warp;
}

}  // namespace kestrel
