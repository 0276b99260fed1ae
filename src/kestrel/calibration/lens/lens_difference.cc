// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens/lens_difference.h"

#include <cmath>
#include <limits>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace kestrel {

std::vector<double> LensDifferencePx(const CameraModel& truth, const CameraModel& estimate,
                                     double max_angle) {
  constexpr int kStepPx = 8;
  std::vector<Eigen::Vector2d> pixels;
  std::vector<Eigen::Vector3d> rays, estimated;
  for (int v = 0; v < truth.height_px(); v += kStepPx) {
    for (int u = 0; u < truth.width_px(); u += kStepPx) {
      const Eigen::Vector2d pixel(u, v);
      Eigen::Vector3d ray, other;
      if (truth.Unproject(pixel, &ray) == ProjectionStatus::kOutsideModel ||
          std::atan2(ray.head<2>().norm(), ray.z()) > max_angle) {
        continue;
      }
      if (estimate.Unproject(pixel, &other) == ProjectionStatus::kOutsideModel) {
        other = Eigen::Vector3d::Zero();  // does not count for the rotation
      }
      pixels.push_back(pixel);
      rays.push_back(ray);
      estimated.push_back(other);
    }
  }
  if (rays.empty()) return {};
  const auto count = std::ssize(rays);
  const Eigen::Map<const Eigen::Matrix3Xd> from(rays.front().data(), 3, count);
  const Eigen::Map<const Eigen::Matrix3Xd> to(estimated.front().data(), 3, count);
  const Eigen::Matrix3d rotation =
      Eigen::umeyama(from, to, /*with_scaling=*/false).topLeftCorner<3, 3>();
  std::vector<double> differences;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Eigen::Vector2d pixel;
    const bool is_seen =
        estimate.Project(rotation * rays[i], &pixel) != ProjectionStatus::kOutsideModel;
    differences.push_back(is_seen ? (pixel - pixels[i]).norm()
                                  : std::numeric_limits<double>::infinity());
  }
  return differences;
}

}  // namespace kestrel
