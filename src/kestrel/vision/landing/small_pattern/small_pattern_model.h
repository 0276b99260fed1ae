// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The model of a small print, shared by its fit and its tests only.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>
#include <Eigen/LU>

#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/image/gray_sampling.h"
#include "kestrel/vision/landing/image_properties.h"
#include "kestrel/vision/landing/small_pattern/small_pattern.h"
#include "kestrel/vision/landing/small_pattern/small_pattern_kernel.h"

namespace kestrel {

// Largest number of pixels of a box around a print for which a fit uses every pixel. A start needs
// half of it, and to distinguish ink from light by its width takes twice as many.
inline constexpr int kEnoughPixels = 1200;

// Returns the matrix from rays to homogeneous coordinates of the plane of a pose.
inline Eigen::Matrix3d PlaneFromRay(const RigidTransform& camera_from_target) {
  const Eigen::Matrix3d rotation = camera_from_target.rotation.toRotationMatrix();
  Eigen::Matrix3d basis;
  basis << rotation.col(0), rotation.col(1), camera_from_target.translation;
  return basis.inverse();
}

inline PrintModel ModelOf(const LandingPattern& pattern, const RigidTransform& pose,
                          double blur_px) {
  PrintModel model;
  const Eigen::Matrix3f plane_from_ray = PlaneFromRay(pose).cast<float>();
  Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(model.plane_from_ray.data()) =
      plane_from_ray;
  model.blur_px = static_cast<float>(blur_px);
  model.inner_radius_m = static_cast<float>(pattern.inner_radius_m());
  model.outer_radius_m = static_cast<float>(pattern.outer_radius_m());
  model.arm_half_width_m = static_cast<float>(0.5 * pattern.arm_width_m);
  model.arm_half_length_m = static_cast<float>(pattern.arm_half_length_m);
  return model;
}

// Returns the quadrant between the arms, counted from x to y.
inline int QuadrantOf(double x, double y) { return x > 0 ? (y > 0 ? 0 : 3) : (y > 0 ? 1 : 2); }

// Correlation of two series, -1 to 1; 0 where one of them is constant.
class Correlation {
 public:
  void Add(double a, double b) {
    ++n_;
    a_ += a;
    aa_ += a * a;
    b_ += b;
    bb_ += b * b;
    ab_ += a * b;
  }
  // 'noise_variance': variance of uncorrelated noise in the first series.
  double value(double noise_variance = 0) const {
    const double of_a = aa_ - a_ * a_ / n_ - n_ * noise_variance;
    const double variances = of_a * (bb_ - b_ * b_ / n_);
    if (!(n_ > 0 && of_a > 0 && variances > 0)) return 0;
    return std::clamp((ab_ - a_ * b_ / n_) / std::sqrt(variances), -1.0, 1.0);
  }

 private:
  double n_ = 0, a_ = 0, aa_ = 0, b_ = 0, bb_ = 0, ab_ = 0;
};

// Returns the correlation of the image with the predicted print, -1 to 1.
inline double CorrelatePrint(const SmallPatternWorkspace& workspace) {
  Correlation with_dark;
  for (std::size_t i = 0; i < workspace.count; ++i) {
    with_dark.Add(workspace.pixels.gray[i], workspace.points.dark[i]);
  }
  return -with_dark.value();
}

// The unknowns of a fit.
struct SmallPatternFitter::State {
  RigidTransform pose;
  double blur_px = LensBlur::kGoodPx;
  double white = 255;   // gray value; the image may saturate below it
  double contrast = 0;  // white minus black
  double noise_variance = 0;

  Eigen::Vector2d slope{0, 0};  // slope of the light over the print, gray values per metre
  double White(double x, double y) const { return white + slope.x() * x + slope.y() * y; }
  // Gray values above white from which on a pixel is a highlight: the print cannot be so bright.
  double Highlight() const {
    constexpr double kMargin = 0.1;  // share of the contrast
    return kMargin * contrast;
  }
  PrintLight Light() const {
    return {.white = static_cast<float>(white),
            .slope_x = static_cast<float>(slope.x()),
            .slope_y = static_cast<float>(slope.y()),
            .contrast = static_cast<float>(contrast),
            .highlight = static_cast<float>(Highlight()),
            .saturated = kSaturatedGray};
  }
};

}  // namespace kestrel
