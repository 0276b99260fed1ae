// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/rendering/lens.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

constexpr double kRimWidthDeg = 0.7;  // width of the soft edge of the lens circle

double DegFromRad(double angle) { return angle * 180 / std::numbers::pi; }

}  // namespace

std::vector<std::string> LensOptions::Validate() const {
  std::vector<std::string> violations;
  Require(half_angle_deg, Range{1, 180}, "half_angle_deg", &violations);
  Require(vignette, Range{0, 1}, "vignette", &violations);
  Require(airframe_radiance, Range{0, 1}, "airframe_radiance", &violations);
  return violations;
}

Lens::Lens(const CameraModel& camera, const LensOptions& options)
    : camera_(camera), options_(options) {
  RequireValid(options);
  const int columns = camera.width_px() + 1;
  const int rows = camera.height_px() + 1;
  corner_rays_.assign(static_cast<std::size_t>(columns) * rows, Eigen::Vector3f::Zero());
  for (int i = 0; i < columns * rows; ++i) {
    const int column = i % columns;
    const int row = i / columns;
    const Eigen::Vector2d corner(column - 0.5, row - 0.5);
    Eigen::Vector3d ray;
    if (camera.Unproject(corner, &ray) != ProjectionStatus::kOutsideModel) {
      corner_rays_[i] = ray.cast<float>();
    }
  }
  gain_.create(camera.height_px(), camera.width_px(), CV_32F);
  airframe_cover_.create(camera.height_px(), camera.width_px(), CV_32F);
  for (int v = 0; v < camera.height_px(); ++v) {
    for (int u = 0; u < camera.width_px(); ++u) {
      gain_.at<float>(v, u) = static_cast<float>(GainAt(u, v));
      const double airframe_distance = options.airframe.NearestEdge({u, v}).distance;
      airframe_cover_.at<float>(v, u) = static_cast<float>(Coverage(airframe_distance, 1));
    }
  }
}

double Lens::GainAt(int u, int v) const {
  const std::array<Eigen::Vector3f, 4> rays = PixelCorners(u, v);
  Eigen::Vector3d sum(0, 0, 0);
  for (const Eigen::Vector3f& ray : rays) {
    if (ray.isZero()) return 0;
    sum += ray.cast<double>();
  }
  const double angle_deg = DegFromRad(std::atan2(sum.head<2>().norm(), sum.z()));
  const double rim = Coverage(angle_deg - options_.half_angle_deg, kRimWidthDeg);
  return rim * (1 - options_.vignette * std::pow(angle_deg / options_.half_angle_deg, 4));
}

std::array<Eigen::Vector3f, 4> Lens::PixelCorners(int u, int v) const {
  const std::size_t stride = camera_.width_px() + 1;
  const Eigen::Vector3f* upper = corner_rays_.data() + v * stride + u;
  const Eigen::Vector3f* lower = upper + stride;
  return {upper[0], upper[1], lower[0], lower[1]};
}

bool Lens::Sees(const Eigen::Vector3d& point_in_camera) const {
  Eigen::Vector2d pixel;
  if (camera_.Project(point_in_camera, &pixel) != ProjectionStatus::kOk) return false;
  const double angle_deg =
      DegFromRad(std::atan2(point_in_camera.head<2>().norm(), point_in_camera.z()));
  return angle_deg < options_.half_angle_deg && options_.airframe.NearestEdge(pixel).distance > 0;
}

Drawing LandingLegs(const CameraIntrinsics& camera, bool four) {
  const double unit = camera.height_px / 480.0;
  const Eigen::Vector2d center(camera.cx_px, camera.cy_px);
  Drawing legs;
  const auto add = [&](const Eigen::Vector2d& foot, const Eigen::Vector2d& away) {
    const Eigen::Vector2d outward = away.normalized();
    legs.Add(Drawing::Ring{center + unit * foot, 15 * unit});
    legs.Add(Drawing::Bar{center + unit * (foot + 100 * outward), outward, 100 * unit, 5 * unit});
  };
  for (const double side : {-1.0, 1.0}) {
    add({190 * side, 160}, {0.55 * side, 0.85});
    if (four) add({332 * side, -168}, {0.95 * side, -0.3});
  }
  return legs;
}

}  // namespace kestrel
