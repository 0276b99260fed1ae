// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/ray_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kestrel {
namespace {

constexpr int kCells = 4096;
constexpr double kMaxTableAngle = 170.0 / 180.0 * std::numbers::pi;
constexpr double kReach = 1.5;  // times the radius of the farthest corner
constexpr double kCorrectionTolerancePx = 0.002;
constexpr int kMaxCorrections = 8;

CameraIntrinsics WithoutTangentialPart(CameraIntrinsics camera) {
  if (camera.distortion_model == DistortionModel::kRadialTangential) {
    camera.distortion[2] = 0;
    camera.distortion[3] = 0;
  }
  return camera;
}

bool HasTangentialPart(const CameraIntrinsics& camera) {
  return camera.distortion_model == DistortionModel::kRadialTangential &&
         (camera.distortion[2] != 0 || camera.distortion[3] != 0);
}

// Distance from the principal point to the farthest corner, in focal lengths.
double CornerRadius(const CameraIntrinsics& camera) {
  const double x = std::max(std::abs(camera.cx_px), std::abs(camera.width_px - camera.cx_px));
  const double y = std::max(std::abs(camera.cy_px), std::abs(camera.height_px - camera.cy_px));
  return std::hypot(x / camera.fx_px, y / camera.fy_px);
}

// Distorted radius (in focal lengths) at which the model of a camera without tangential part ends.
double ModelRadius(const CameraModel& radial) {
  const double angle = std::min(radial.max_angle() * (1 - 1e-12), kMaxTableAngle);
  Eigen::Vector2d pixel;
  radial.Project({std::sin(angle), 0, std::cos(angle)}, &pixel);
  return (pixel.x() - radial.intrinsics().cx_px) / radial.intrinsics().fx_px;
}

// tan(theta / 2) / radius of a camera without tangential part.
double HalfTangentOverRadius(const CameraModel& radial, double radius) {
  Eigen::Vector3d ray;
  radial.Unproject(
      {radial.intrinsics().cx_px + radial.intrinsics().fx_px * radius, radial.intrinsics().cy_px},
      &ray);
  return ray.x() / (1 + ray.z()) / radius;
}

}  // namespace

RayTable::RayTable(const CameraModel& camera) : table_(kCells + 2) {
  const CameraIntrinsics& intrinsics = camera.intrinsics();
  const CameraModel radial(WithoutTangentialPart(intrinsics));
  const double end_radius = std::min(ModelRadius(radial), kReach * CornerRadius(intrinsics));
  for (int i = 0; i <= kCells; ++i) {
    // At the centre the quotient is undefined, but has a limit.
    const double radius = end_radius * std::max(std::sqrt(1.0 * i / kCells), 1e-6);
    table_[i] = static_cast<float>(HalfTangentOverRadius(radial, radius));
  }
  table_[kCells + 1] = table_[kCells];  // read when rounding moves the last cell to its end

  kernel_.cells_per_q = static_cast<float>(kCells / (end_radius * end_radius));
  kernel_.end_q = static_cast<float>(end_radius * end_radius);
  kernel_.min_z = static_cast<float>(std::cos(camera.max_angle()) - 1e-6);
  kernel_.cx_px = static_cast<float>(intrinsics.cx_px);
  kernel_.cy_px = static_cast<float>(intrinsics.cy_px);
  kernel_.inverse_fx = static_cast<float>(1 / intrinsics.fx_px);
  kernel_.inverse_fy = static_cast<float>(1 / intrinsics.fy_px);
  if (!HasTangentialPart(intrinsics)) return;

  kernel_.p1 = static_cast<float>(intrinsics.distortion[2]);
  kernel_.p2 = static_cast<float>(intrinsics.distortion[3]);
  while (kernel_.corrections < kMaxCorrections && MaxErrorPx(camera) > kCorrectionTolerancePx) {
    ++kernel_.corrections;
  }
}

// Largest difference from the exact inverse on a grid over the image: angle times focal length.
double RayTable::MaxErrorPx(const CameraModel& camera) const {
  constexpr int kSamples = 24;
  double max_angle = 0;
  for (int row = 0; row <= kSamples; ++row) {
    for (int column = 0; column <= kSamples; ++column) {
      const float u_px = static_cast<float>(column * (camera.width_px() - 1)) / kSamples;
      const float v_px = static_cast<float>(row * (camera.height_px() - 1)) / kSamples;
      Eigen::Vector3d exact;
      if (camera.Unproject({u_px, v_px}, &exact) == ProjectionStatus::kOutsideModel) continue;
      max_angle = std::max(max_angle, (Ray(u_px, v_px).cast<double>() - exact).norm());
    }
  }
  return max_angle * std::max(camera.intrinsics().fx_px, camera.intrinsics().fy_px);
}

}  // namespace kestrel
