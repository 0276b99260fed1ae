// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/random.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {

// Gray value at a point (m) of the plane z = 0 of the pattern's frame; the ground around it is
// gray.
inline double PatternGray(const LandingPattern& pattern, double x, double y) {
  const double radius = std::hypot(x, y);
  const auto is_arm = [&](double along, double across) {
    return std::abs(along) < pattern.arm_half_length_m &&
           std::abs(across) < pattern.arm_width_m / 2;
  };
  const bool is_ring = radius > pattern.inner_radius_m() && radius < pattern.outer_radius_m();
  if (is_ring || is_arm(x, y) || is_arm(y, x)) return 30;
  return std::max(std::abs(x), std::abs(y)) < pattern.board_size_m / 2 ? 220 : 120;
}

// Draws the pattern as the camera sees it: 3 x 3 rays per pixel, then a slight blur as of a lens.
inline cv::Mat DrawPattern(const CameraModel& camera, const LandingPattern& pattern,
                           const RigidTransform& camera_from_target) {
  constexpr int kRays = 3;
  const RigidTransform pattern_from_camera = camera_from_target.Inverse();
  cv::Mat image(camera.height_px(), camera.width_px(), CV_8UC1);
  image.forEach<std::uint8_t>([&](std::uint8_t& gray, const int* position) {
    double sum = 0;
    for (int i = 0; i < kRays * kRays; ++i) {
      const int column = i % kRays;
      const int row = i / kRays;
      const Eigen::Vector2d pixel(position[1] + (column + 0.5) / kRays - 0.5,
                                  position[0] + (row + 0.5) / kRays - 0.5);
      Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();
      camera.Unproject(pixel, &ray);
      ray = pattern_from_camera.rotation * ray;
      const Eigen::Vector3d& origin = pattern_from_camera.translation;
      const Eigen::Vector3d point = origin - origin.z() / ray.z() * ray;
      sum += PatternGray(pattern, point.x(), point.y());
    }
    gray = cv::saturate_cast<std::uint8_t>(sum / (kRays * kRays));
  });
  cv::GaussianBlur(image, image, cv::Size(), 0.6);
  return image;
}

// Draws the whole pattern 2 to 5 m away, anywhere in the image, tilted by up to 45 degrees in any
// direction, with noise.
inline cv::Mat DrawRandomView(const CameraModel& camera, const LandingPattern& pattern,
                              Random* random) {
  const double angle = random->Uniform(0, 2 * M_PI);
  const Eigen::Vector3d tilt_axis(std::cos(angle), std::sin(angle), 0);
  const double u_px = camera.width_px() * random->Uniform(0.25, 0.75);
  const double v_px = camera.height_px() * random->Uniform(0.3, 0.7);
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();
  camera.Unproject({u_px, v_px}, &ray);
  const double yaw = random->Uniform(0, 2 * M_PI);
  const double tilt = random->Uniform(0, M_PI / 4);
  const double distance_m = random->Uniform(2, 5);
  const RigidTransform pose = {Eigen::AngleAxisd(tilt, tilt_axis) *
                                   Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()) *
                                   Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()),
                               distance_m * ray};
  cv::Mat image = DrawPattern(camera, pattern, pose);
  constexpr double kNoise = 2;
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      auto& gray = image.at<std::uint8_t>(v, u);
      gray = cv::saturate_cast<std::uint8_t>(gray + kNoise * random->Normal());
    }
  }
  return image;
}

}  // namespace kestrel
