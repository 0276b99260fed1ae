// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "kestrel/core/base/random.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/image/border_tracing.h"
#include "kestrel/core/image/test_figures.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {

// A print: true where it is black at a point (x, y) of its plane, metres.
using Print = std::function<bool(double, double)>;

inline CameraModel TestPrintCamera() {
  return CameraModel({320, 240, 220, 220, 159.5, 119.5, DistortionModel::kNone, {}});
}

// True on one of 'count' half arms from the centre, at equal angles, the first along x.
inline bool IsSpoke(double x, double y, int count, double half_width, double length) {
  const double radius = std::hypot(x, y);
  if (radius > length + half_width) return false;
  const double step = 2 * std::numbers::pi / count;
  const double turn = std::remainder(std::atan2(y, x), step);
  const double along = radius * std::cos(turn);
  return along > 0 && along < length && std::abs(radius * std::sin(turn)) < half_width;
}

inline bool IsRing(const LandingPattern& pattern, double x, double y) {
  const double radius = std::hypot(x, y);
  return radius > pattern.inner_radius_m() && radius < pattern.outer_radius_m();
}

// Height (m) of a sheet that is not flat, over a point of its plane, metres.
using SheetHeight = std::function<double(double, double)>;

// The landing pattern with 'spokes' spokes; with four it is the pattern itself.
inline Print SpokedPrint(const LandingPattern& pattern, int spokes) {
  return [=](double x, double y) {
    return IsRing(pattern, x, y) ||
           IsSpoke(x, y, spokes, 0.5 * pattern.arm_width_m, pattern.arm_half_length_m);
  };
}

// Pose of a print that faces the camera, tilted about 'tilt_axis' (rad, direction in the camera's
// x, y plane) and turned.
inline RigidTransform PrintPose(const Eigen::Vector3d& center, double tilt, double tilt_axis,
                                double turn) {
  RigidTransform pose;
  const Eigen::Vector3d axis(std::cos(tilt_axis), std::sin(tilt_axis), 0);
  // The face looks at the camera: z up out of the print is -z of the camera.
  pose.rotation = Eigen::AngleAxisd(tilt, axis) *
                  Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()) *
                  Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
  pose.translation = center;
  return pose;
}

// Draws the print on a white board on gray ground. A pixel is the mean of 8 x 8 rays where its
// corners, sides and centre differ. 'height': of a board that is not flat.
inline cv::Mat DrawPrint(const CameraModel& camera, const LandingPattern& pattern,
                         const Print& print, const RigidTransform& camera_from_target,
                         const SheetHeight& height = {}) {
  const RigidTransform pattern_from_camera = camera_from_target.Inverse();
  const Eigen::Matrix3d rotation = pattern_from_camera.rotation.toRotationMatrix();
  const Eigen::Vector3d& origin = pattern_from_camera.translation;
  const CameraIntrinsics& lens = camera.intrinsics();
  const bool is_distorted = lens.distortion_model != DistortionModel::kNone;
  const auto gray_at = [&](double u, double v) {
    Eigen::Vector3d ray((u - lens.cx_px) / lens.fx_px, (v - lens.cy_px) / lens.fy_px, 1);
    if (is_distorted) {
      ray = Eigen::Vector3d::UnitZ();
      camera.Unproject({u, v}, &ray);
    }
    ray = rotation * ray;
    const double across = ray.x() / ray.z(), down = ray.y() / ray.z();
    double x = origin.x() - origin.z() * across;
    double y = origin.y() - origin.z() * down;
    // The height is taken at the point that is seen, found by iteration.
    for (int i = 0; height && i < 6; ++i) {
      const double lower = origin.z() - height(x, y);
      x = origin.x() - lower * across;
      y = origin.y() - lower * down;
    }
    if (std::max(std::abs(x), std::abs(y)) > 0.5 * pattern.board_size_m) return 120;
    return print(x, y) ? 40 : 200;
  };
  // The corners, edges and middles of all pixels: neighbours share them.
  cv::Mat lattice(2 * camera.height_px() + 1, 2 * camera.width_px() + 1, CV_8UC1);
  for (int v = 0; v < lattice.rows; ++v) {
    for (int u = 0; u < lattice.cols; ++u) {
      lattice.at<std::uint8_t>(v, u) =
          static_cast<std::uint8_t>(gray_at(0.5 * (u - 1), 0.5 * (v - 1)));
    }
  }
  const auto is_even = [&](int u, int v) {
    const cv::Mat pixel = lattice(cv::Rect(2 * u, 2 * v, 3, 3));
    for (int i = 0; i < 9; ++i) {
      if (pixel.at<std::uint8_t>(i / 3, i % 3) != pixel.at<std::uint8_t>(1, 1)) return false;
    }
    return true;
  };
  constexpr int kRays = 8;
  cv::Mat image(camera.height_px(), camera.width_px(), CV_8UC1);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      std::uint8_t& pixel = image.at<std::uint8_t>(v, u);
      pixel = lattice.at<std::uint8_t>(2 * v + 1, 2 * u + 1);
      if (is_even(u, v)) continue;
      double sum = 0;
      for (int i = 0; i < kRays * kRays; ++i) {
        const int column = i % kRays;
        const int row = i / kRays;
        sum += gray_at(u + (column + 0.5) / kRays - 0.5, v + (row + 0.5) / kRays - 0.5);
      }
      pixel = static_cast<std::uint8_t>(std::lround(sum / (kRays * kRays)));
    }
  }
  return image;
}

// Traces the borders of a figure, given in pixels, on bright ground.
inline BorderTracer TraceFigure(const Print& is_dark, int width, int height) {
  BorderTracer tracer;
  tracer.Trace(DrawFigure(width, height, is_dark), cv::Rect(0, 0, width, height), BorderLimits{});
  return tracer;
}

// Returns a copy with normal noise of standard deviation 'sigma', gray values.
inline cv::Mat AddNoise(const cv::Mat& image, double sigma, Random* random) {
  cv::Mat noisy = image.clone();
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const double gray = image.at<std::uint8_t>(v, u) + sigma * random->Normal();
      noisy.at<std::uint8_t>(v, u) =
          static_cast<std::uint8_t>(std::lround(std::clamp(gray, 0.0, 255.0)));
    }
  }
  return noisy;
}

// Error of a pose: translation and rotation vector in the camera frame, the rotation modulo the
// right angles under which the print looks the same.
inline Eigen::Matrix<double, 6, 1> PoseError(const RigidTransform& found,
                                             const RigidTransform& truth) {
  Eigen::Matrix<double, 6, 1> best;
  double least = 1e9;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const Eigen::Quaterniond turned =
        truth.rotation *
        Eigen::AngleAxisd(quarter * std::numbers::pi / 2, Eigen::Vector3d::UnitZ());
    const Eigen::AngleAxisd difference(found.rotation * turned.conjugate());
    if (difference.angle() > least) continue;
    least = difference.angle();
    best << found.translation - truth.translation, difference.angle() * difference.axis();
  }
  return best;
}

}  // namespace kestrel
