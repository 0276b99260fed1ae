// SPDX-License-Identifier: BSD-3-Clause
// Images of a car on textured ground, from a UAV that flies around it, for tests.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/region/test_region_scene.h"

namespace kestrel {

// The pose of a camera at 'from' whose optical axis goes through 'to', with the horizon level.
inline RigidTransform LookingFrom(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d ahead = (to - from).normalized();
  Eigen::Vector3d right = ahead.cross(Eigen::Vector3d::UnitZ());
  right = right.norm() > 1e-6 ? right.normalized() : Eigen::Vector3d(Eigen::Vector3d::UnitX());
  Eigen::Matrix3d rotation;
  rotation << right, ahead.cross(right), ahead;
  return {Eigen::Quaterniond(rotation), from};
}

class FollowScene {
 public:
  explicit FollowScene(std::uint64_t seed)
      : random_(seed),
        ground_(RegionTexture({1400, 1400}, seed + 1, 9)),
        paint_(RegionTexture({64, 64}, seed + 2, 30)) {}

  static CameraIntrinsics Camera() {
    return {320, 240, 250, 250, 159.5, 119.5, DistortionModel::kNone, {}};
  }

  // 'car': the middle of its underside.
  cv::Mat Take(const RigidTransform& world_from_camera, const Eigen::Vector3d& car) {
    cv::Mat image(camera_.height_px(), camera_.width_px(), CV_8UC3);
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();
        camera_.Unproject({x, y}, &ray);
        ray = world_from_camera.rotation * ray;
        const auto on_car = CarAlong(world_from_camera.translation - car, ray);
        cv::Vec3b& pixel = image.at<cv::Vec3b>(y, x);
        pixel = on_car ? *on_car : GroundAlong(world_from_camera.translation, ray);
        for (int c = 0; c < 3; ++c) {
          pixel[c] = cv::saturate_cast<std::uint8_t>(pixel[c] + 3 * random_.Normal());
        }
      }
    }
    return image;
  }

  // The box in the image around the car.
  cv::Rect2d BoxOf(const RigidTransform& world_from_camera, const Eigen::Vector3d& car) const {
    Eigen::Array2d low(1e9, 1e9), high(-1e9, -1e9);
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      const Eigen::Vector3d point = car + Middle() + sign.cwiseProduct(Half());
      Eigen::Vector2d pixel;
      camera_.Project(world_from_camera.Inverse() * point, &pixel);
      low = low.min(pixel.array());
      high = high.max(pixel.array());
    }
    return {low.x(), low.y(), high.x() - low.x() + 1, high.y() - low.y() + 1};
  }

 private:
  static constexpr double kTexel_m = 0.1;
  static Eigen::Vector3d Half() { return {2, 0.9, 0.7}; }
  static Eigen::Vector3d Middle() { return {0, 0, 0.7}; }

  std::optional<cv::Vec3b> CarAlong(const Eigen::Vector3d& from_car,
                                    const Eigen::Vector3d& ray) const {
    const Eigen::Array3d from = from_car - Middle();
    const Eigen::Array3d a = (-Half().array() - from) / ray.array();
    const Eigen::Array3d b = (Half().array() - from) / ray.array();
    const double near = a.min(b).maxCoeff(), far = a.max(b).minCoeff();
    if (!(near > 0 && near < far)) return std::nullopt;
    const Eigen::Array3d hit = (from + near * ray.array() + Half().array()) * (16 / 2.0);
    const int u = static_cast<int>(hit.x() + 3 * hit.z()) & 63;
    const int v = static_cast<int>(hit.y() + 5 * hit.z()) & 63;
    return paint_.at<cv::Vec3b>(v, u);
  }

  cv::Vec3b GroundAlong(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) const {
    if (ray.z() > -0.02) return {230, 210, 190};  // sky, and what is too far
    const Eigen::Vector3d at = from - from.z() / ray.z() * ray;
    const auto texel = [](double along_m, int size) {
      const double wrapped = std::fmod(along_m / kTexel_m + 100.0 * size, size);
      return std::clamp(static_cast<int>(wrapped), 0, size - 1);
    };
    return ground_.at<cv::Vec3b>(texel(at.y(), ground_.rows), texel(at.x(), ground_.cols));
  }

  CameraModel camera_{Camera()};
  Random random_;
  cv::Mat ground_, paint_;
};

}  // namespace kestrel
