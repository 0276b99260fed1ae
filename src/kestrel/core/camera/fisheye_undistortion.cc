// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/fisheye_undistortion.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr int kIterations = 10;

// tan(theta_10) / theta_0 of Algorithm 1; 1 on the axis, its limit.
double UndistortionScale(const std::vector<double>& k, double theta_0) {
  if (theta_0 == 0) return 1;
  double theta = theta_0;
  for (int i = 0; i < kIterations; ++i) {
    const double s = theta * theta;
    theta = theta_0 / (1 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3]))));
  }
  return std::tan(theta) / theta_0;
}

void RequireEquidistant(const CameraIntrinsics& camera) {
  if (camera.distortion_model != DistortionModel::kEquidistant) {
    throw InputError("fisheye undistortion: the camera has another lens, expected equidistant");
  }
  const std::vector<std::string> violations = camera.Validate();
  if (!violations.empty()) {
    throw InputError(fmt::format("fisheye undistortion: {}", fmt::join(violations, "; ")));
  }
}

double SquaredCornerRadius(const CameraIntrinsics& camera) {
  const double x = std::max(camera.cx_px, camera.width_px - 1 - camera.cx_px) / camera.fx_px;
  const double y = std::max(camera.cy_px, camera.height_px - 1 - camera.cy_px) / camera.fy_px;
  return x * x + y * y;
}

}  // namespace

Eigen::Vector2d UndistortIterative(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d w((pixel.x() - camera.cx_px) / camera.fx_px,
                          (pixel.y() - camera.cy_px) / camera.fy_px);
  return UndistortionScale(camera.distortion, w.norm()) * w;
}

FisheyeUndistortionTable::FisheyeUndistortionTable(const CameraIntrinsics& camera)
    : scale_(kEntries),
      center_px_(static_cast<float>(camera.cx_px), static_cast<float>(camera.cy_px)) {
  RequireEquidistant(camera);
  inverse_focal_ = Eigen::Array2d(1 / camera.fx_px, 1 / camera.fy_px).cast<float>();
  const double end = SquaredCornerRadius(camera);
  for (int i = 0; i < kEntries; ++i) {
    const double theta_0 = std::sqrt(end * i / (kEntries - 1));
    scale_[i] = static_cast<float>(UndistortionScale(camera.distortion, theta_0));
  }
  entries_per_squared_radius_ = static_cast<float>((kEntries - 1) / end);
}

Eigen::Vector2f FisheyeUndistortionTable::Undistort(const Eigen::Vector2f& pixel) const {
  const Eigen::Vector2f w = (pixel.array() - center_px_) * inverse_focal_;
  const float position = w.squaredNorm() * entries_per_squared_radius_ + 0.5f;
  const int entry = static_cast<int>(std::min(position, kEntries - 1.0f));
  return scale_[entry] * w;
}

}  // namespace kestrel
