// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/target/part_below_horizon.h"

#include <algorithm>
#include <cmath>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr int kTile_px = 32;       // the coarsest thresholds look at whole tiles
constexpr double kLeastSky = 0.2;  // as a share of the image

enum class Place { kGround, kSky, kOutside };

struct Horizon {
  const Eigen::Vector3d& up;
  double margin_rad;
};

Place PlaceOf(const CameraModel& camera, const Horizon& horizon, int x, int y) {
  Eigen::Vector3d ray;
  if (camera.Unproject(Eigen::Vector2d(x, y), &ray) == ProjectionStatus::kOutsideModel) {
    return Place::kOutside;
  }
  return ray.normalized().dot(horizon.up) > std::sin(horizon.margin_rad) ? Place::kSky
                                                                         : Place::kGround;
}

// Whether a corner of the image, the middle of an edge or the middle shows the sky.
bool HasSky(const CameraModel& camera, const Horizon& horizon, const cv::Rect& whole) {
  for (const int x : {0, whole.width / 2, whole.width - 1}) {
    for (const int y : {0, whole.height / 2, whole.height - 1}) {
      if (PlaceOf(camera, horizon, x, y) == Place::kSky) return true;
    }
  }
  return false;
}

}  // namespace

std::optional<cv::Rect> PartBelowHorizon(const CameraModel& camera,
                                         const Eigen::Vector3d& up_in_camera, double margin_rad) {
  if (margin_rad >= kPi / 2) return std::nullopt;  // nothing is known to be sky
  const Horizon horizon{up_in_camera, margin_rad};
  const cv::Rect whole(0, 0, camera.width_px(), camera.height_px());
  if (!HasSky(camera, horizon, whole)) return std::nullopt;
  cv::Rect part;
  for (int y = 0; y <= whole.height; y += kTile_px) {
    for (int x = 0; x <= whole.width; x += kTile_px) {
      if (PlaceOf(camera, horizon, x, y) != Place::kGround) continue;
      part |= cv::Rect(x - kTile_px, y - kTile_px, 2 * kTile_px, 2 * kTile_px);
    }
  }
  part &= whole;
  const bool is_worthwhile = part.area() < (1 - kLeastSky) * whole.area();
  return part.empty() || !is_worthwhile ? std::nullopt : std::optional(part);
}

}  // namespace kestrel
