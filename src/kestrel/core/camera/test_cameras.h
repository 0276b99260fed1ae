// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/camera/paper_camera.h"

namespace kestrel {

inline constexpr double kDegree = std::numbers::pi / 180;

struct TestCamera {
  std::string name;
  CameraIntrinsics intrinsics;
};

inline void PrintTo(const TestCamera& camera, std::ostream* out) { *out << camera.name; }

// EuRoC MAV cam0.
inline CameraIntrinsics EurocCamera() {
  return {752,
          480,
          458.654,
          457.296,
          367.215,
          248.375,
          DistortionModel::kRadialTangential,
          {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05}};
}

// Cameras with every model: mostly real ones, and one lens of each kind that folds back.
inline std::vector<TestCamera> TestCameras() {
  using Model = DistortionModel;
  return {
      {"paper", PaperCamera()},
      {"tum_vi",
       {512,
        512,
        190.978,
        190.973,
        254.932,
        256.897,
        Model::kEquidistant,
        {0.0034824, 0.0007150, -0.0020532, 0.0002029}}},
      {"folding_fisheye",
       {1280, 960, 420, 421, 640.2, 477.1, Model::kEquidistant, {-0.05, -0.02, 0, 0}}},
      {"euroc", EurocCamera()},
      {"five_coefficients",
       {1280,
        720,
        800,
        805,
        640.5,
        361,
        Model::kRadialTangential,
        {-0.3, 0.1, 0.0005, -0.0003, -0.012}}},
      {"rational",
       {1280,
        720,
        607.6,
        607.4,
        637.1,
        366.9,
        Model::kRadialTangential,
        {0.4612, -2.6424, 0.00048, -0.00026, 1.5236, 0.3427, -2.4613, 1.4487}}},
      {"folding_radial",
       {640, 480, 350, 352, 320, 238, Model::kRadialTangential, {-0.35, 0, 0, 0}}},
      {"strong_tangential",
       {640, 480, 420, 420, 322, 241, Model::kRadialTangential, {-0.3, 0.1, 0.01, -0.006}}},
      {"pinhole", {640, 360, 370, 370, 319.5, 179.5, Model::kNone, {}}},
  };
}

inline Eigen::Vector3d RayAt(double angle, double azimuth) {
  return {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth),
          std::cos(angle)};
}

// Angle (rad) between two unit vectors, exact for small angles too.
inline double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return 2 * std::atan2((a - b).norm(), (a + b).norm());
}

}  // namespace kestrel
