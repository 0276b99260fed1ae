// SPDX-License-Identifier: BSD-3-Clause
// Prints Table 1 of the paper: the largest error of several methods from a pixel to a direction, by
// the angle of the direction to the optical axis, compared with the exact inverse.
#include <algorithm>
#include <array>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <opencv2/calib3d.hpp>

#include "kestrel/core/camera/fisheye_undistortion.h"
#include "kestrel/core/camera/ray_table.h"
#include "kestrel/core/camera/test_cameras.h"

namespace kestrel {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Method {
  std::string name;
  std::function<Eigen::Vector3d(const Eigen::Vector2d& pixel)> direction;
};

Eigen::Vector3d OpenCvDirection(const CameraIntrinsics& c, const Eigen::Vector2d& pixel) {
  const cv::Matx33d matrix(c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1);
  std::vector<cv::Point2d> point{{pixel.x(), pixel.y()}};
  cv::fisheye::undistortPoints(point, point, matrix, cv::Vec4d(c.distortion.data()));
  return {point[0].x, point[0].y, 1};
}

std::vector<Method> Methods(const CameraIntrinsics& camera) {
  const RayTable rays{CameraModel(camera)};
  const FisheyeUndistortionTable table(camera);
  return {{"Algorithm 1",
           [camera](const Eigen::Vector2d& pixel) {
             return UndistortIterative(camera, pixel).homogeneous().eval();
           }},
          {"Algorithm 2",
           [table](const Eigen::Vector2d& pixel) {
             return table.Undistort(pixel.cast<float>()).cast<double>().homogeneous().eval();
           }},
          {"RayTable",
           [rays](const Eigen::Vector2d& pixel) {
             const Eigen::Vector2f p = pixel.cast<float>();
             return rays.Ray(p.x(), p.y()).cast<double>().eval();
           }},
          {"cv::fisheye",
           [camera](const Eigen::Vector2d& pixel) { return OpenCvDirection(camera, pixel); }}};
}

// Largest error in pixels for angles in (low, high]. The ring is sampled as finely as the pixels.
double MaxErrorPx(const CameraModel& camera, const Method& method, double low_deg,
                  double high_deg) {
  constexpr int kAngles = 4000;
  constexpr int kAzimuths = 8;
  double max_error_px = 0;
  for (int i = 1; i <= kAngles; ++i) {
    const double angle = (low_deg + (high_deg - low_deg) * i / kAngles) * kDegree;
    for (int j = 0; j < kAzimuths; ++j) {
      const double azimuth = 2 * std::numbers::pi * j / kAzimuths + 0.1;
      const Eigen::Vector3d ray = RayAt(angle, azimuth);
      const Eigen::Vector3d outwards = RayAt(angle + std::numbers::pi / 2, azimuth);
      Eigen::Vector2d pixel;
      Eigen::Matrix<double, 2, 3> jacobian;
      camera.Project(ray, &pixel, &jacobian);
      const double local_focal_px = (jacobian * outwards).norm();
      max_error_px = std::max(
          max_error_px, AngleBetween(method.direction(pixel).normalized(), ray) * local_focal_px);
    }
  }
  return max_error_px;
}

void PrintTable() {
  constexpr std::array kLimits_deg{0.0,  10.0, 20.0, 30.0, 40.0, 50.0,
                                   60.0, 70.0, 80.0, 85.0, 90.0, 92.5};
  const CameraModel camera(PaperCamera());
  const std::vector<Method> methods = Methods(camera.intrinsics());
  fmt::print(
      "Largest error in pixels: the angle (rad) between the direction found and the true one, "
      "times\n"
      "the local focal length d(radius in px) / d(angle to the axis), for true directions up to "
      "the\n"
      "angle to the axis in the first column and above the one in the row before. A point of the\n"
      "undistorted plane counts as the direction (x', y', 1).\n\n");
  fmt::print("| angle [deg] | radius [px] |");
  for (const Method& method : methods) fmt::print(" {} |", method.name);
  fmt::print("\n|---:|---:|---:|---:|---:|---:|\n");
  for (std::size_t i = 1; i < kLimits_deg.size(); ++i) {
    const double limit = kLimits_deg[i] * kDegree;
    Eigen::Vector2d pixel;
    camera.Project(RayAt(limit, 0), &pixel);
    fmt::print("| {} | {:.1f} |", kLimits_deg[i], pixel.x() - camera.intrinsics().cx_px);
    for (const Method& method : methods) {
      fmt::print(" {:.2g} |", MaxErrorPx(camera, method, kLimits_deg[i - 1], kLimits_deg[i]));
    }
    fmt::print("\n");
  }
}

}  // namespace
}  // namespace kestrel

int main() { kestrel::PrintTable(); }
