// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "kestrel/calibration/lens/lens_view.h"
#include "kestrel/core/base/random.h"
#include "kestrel/vision/landing/alignment/print_outline.h"
#include "kestrel/vision/landing/test_prints.h"
#include "kestrel/vision/target/plane_warp.h"

namespace kestrel {

struct TestLensViews {
  int count = 40;
  int seed = 1;
  double max_tilt_deg = 50;
  double share_of_image = 1;  // share of its width and height in which the pattern's centre lies
  double noise_px = 0.1;      // standard deviation of an edge
};

// Returns a camera's edges of the pattern from random poses. The given poses have an error of some
// degrees and percent.
inline std::vector<LensView> MakeLensViews(const CameraIntrinsics& intrinsics,
                                           const TestLensViews& options) {
  constexpr double kDegrees = std::numbers::pi / 180;
  constexpr std::size_t kMinEdges = 60;
  const CameraModel camera(intrinsics);
  const PrintOutline outline{LandingPattern()};
  Random random(static_cast<std::uint64_t>(options.seed));
  std::vector<LensView> views;
  while (std::ssize(views) < options.count) {
    const double u = 0.5 + options.share_of_image * random.Uniform(-0.5, 0.5);
    const double v = 0.5 + options.share_of_image * random.Uniform(-0.5, 0.5);
    Eigen::Vector3d ray;
    if (camera.Unproject({u * intrinsics.width_px, v * intrinsics.height_px}, &ray) !=
        ProjectionStatus::kOk) {
      continue;
    }
    // The pattern is tilted against the line of sight as far as the options allow.
    const double tilt = random.Uniform(0, options.max_tilt_deg * kDegrees);
    const double tilt_axis = random.Uniform(0, 2 * std::numbers::pi);
    const double distance = random.Uniform(1.3, 2.5) * intrinsics.fx_px / 300;
    const double yaw = random.Uniform(0, 2 * std::numbers::pi);
    const RigidTransform pose = PrintPose(distance * ray, tilt, tilt_axis, yaw);
    // At such a flat angle its edges would not be found.
    if (-(pose.rotation * Eigen::Vector3d::UnitZ()).dot(ray) < 0.4) continue;
    LensView view{"view " + std::to_string(views.size()), {}, pose};
    const PlaneWarp warp(camera, pose, outline.radius_m());
    for (const PrintOutline::Place& place : outline.all()) {
      Eigen::Vector2d pixel;
      Eigen::Matrix2d d_plane;
      if (!warp.Project(place.point, &pixel, &d_plane) || (pixel.array() < 0).any() ||
          pixel.x() >= intrinsics.width_px || pixel.y() >= intrinsics.height_px) {
        continue;
      }
      const Eigen::Vector2d along =
          (d_plane * Eigen::Vector2d(-place.normal.y(), place.normal.x())).normalized();
      Eigen::Vector2d across(-along.y(), along.x());
      if (across.dot(d_plane * place.normal) < 0) across = -across;
      view.edges.push_back(
          {place.point, pixel + options.noise_px * random.Normal() * across, across});
    }
    if (view.edges.size() < kMinEdges) continue;
    view.camera_from_target =
        Moved(pose, 0.03 * random.Normal() * pose.translation,
              0.05 * Eigen::Vector3d(random.Normal(), random.Normal(), random.Normal()));
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace kestrel
