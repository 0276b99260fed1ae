// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/rendering/frame_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace kestrel {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

// Time step of numerical velocities, s.
constexpr double kVelocityStep_s = 1e-3;

PlacedSurface GroundPlane() { return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}; }

// A cone around a surface, seen by the camera during the whole exposure.
struct ViewCone {
  Vector3f axis;
  float radius;  // rad; pi: all around
};

ViewCone ConeAround(const Surface& surface, const Motion& world_from_body,
                    const std::vector<RigidTransform>& cameras,
                    const std::vector<double>& times_s) {
  constexpr double kMotionMargin = 1.2;
  const double size = std::sqrt(surface.right.squaredNorm() + surface.up.squaredNorm());
  constexpr int kLooks = 9;
  std::array<Vector3d, kLooks> directions;
  double radius = 0;
  for (int i = 0; i < kLooks; ++i) {
    const std::size_t k = i * (times_s.size() - 1) / (kLooks - 1);
    const Vector3d center = cameras[k].Inverse() * (world_from_body(times_s[k]) * surface.center);
    const double range = center.norm();
    if (range <= size) return {Vector3f::UnitZ(), std::numbers::pi_v<float>};
    directions[i] = center / range;
    radius = std::max(radius, std::asin(size / range));
  }
  const Vector3d& middle = directions[kLooks / 2];
  double motion = 0;
  for (const Vector3d& direction : directions) {
    motion = std::max(motion, std::acos(std::clamp(direction.dot(middle), -1.0, 1.0)));
  }
  return {middle.cast<float>(), static_cast<float>(radius + kMotionMargin * motion + 1e-3)};
}

// Returns the homography of a rectangle in the camera frame; zero when its back is seen.
Eigen::Matrix3f HomographyOf(const PlacedSurface& in_camera) {
  Matrix3d columns;
  columns << in_camera.right, in_camera.up, in_camera.center;
  if (columns.determinant() >= 0) return Eigen::Matrix3f::Zero();
  return columns.inverse().cast<float>();
}

PlacedSurface GroundInCamera(const RigidTransform& world_from_camera) {
  const RigidTransform camera_from_world = world_from_camera.Inverse();
  return {camera_from_world.translation, camera_from_world.rotation * Vector3d::UnitX(),
          camera_from_world.rotation * Vector3d::UnitY()};
}

// Returns the map from (x, y, 1) on a rectangle to the point of the ground on the same ray of the
// sun.
Eigen::Matrix<float, 2, 3> AlongSunToGround(const PlacedSurface& at, const Vector3d& to_sun) {
  Eigen::Matrix<double, 2, 3> project;
  project << 1, 0, -to_sun.x() / to_sun.z(), 0, 1, -to_sun.y() / to_sun.z();
  Matrix3d point;
  point << at.right, at.up, at.center;
  return (project * point).cast<float>();
}

}  // namespace

ImageTiles::ImageTiles(const Lens& lens) {
  const cv::Mat& gain = lens.gain();
  for (int top = 0; top < gain.rows; top += kSide_px) {
    for (int left = 0; left < gain.cols; left += kSide_px) {
      Tile tile{.left = left, .top = top, .rim = {}};
      Vector3f sum(0, 0, 0);
      for (int v = top; v < std::min(top + kSide_px, gain.rows); ++v) {
        for (int u = left; u < std::min(left + kSide_px, gain.cols); ++u) {
          if (gain.at<float>(v, u) <= 0) continue;
          for (const Vector3f& ray : lens.PixelCorners(u, v)) {
            tile.rim.push_back(ray);
            sum += ray;
          }
        }
      }
      tile.dark = tile.rim.empty();
      if (!tile.dark) {
        tile.axis = sum.normalized();
        for (const Vector3f& ray : tile.rim) {
          const float cosine = std::clamp(ray.dot(tile.axis), -1.0f, 1.0f);
          tile.radius = std::max(tile.radius, std::acos(cosine));
        }
      }
      // A few rays around a square of pixels are enough to find where it looks.
      std::vector<Vector3f> few;
      const std::size_t step = std::max<std::size_t>(tile.rim.size() / 48, 1);
      for (std::size_t i = 0; i < tile.rim.size(); i += step) few.push_back(tile.rim[i]);
      tile.rim = std::move(few);
      tiles_.push_back(std::move(tile));
    }
  }
}

FrameView::FrameView(const World& world, const ImageTiles& tiles, const Motion& world_from_camera,
                     const std::vector<double>& times_s, double time_s) {
  std::vector<RigidTransform> cameras;
  cameras.reserve(times_s.size());
  for (const double time : times_s) {
    cameras.push_back(world_from_camera(time));
    rotations_.push_back(cameras.back().rotation.toRotationMatrix().cast<float>());
  }
  seen_.emplace_back();
  FindVisible(world, tiles, cameras, times_s);
  MakeHomographies(world, cameras, times_s);
  Light(world, world_from_camera(time_s), time_s);
  MapShadows(world, time_s);
  FindGroundShadows(tiles, static_cast<int>(times_s.size() / 2));
}

void FrameView::FindVisible(const World& world, const ImageTiles& tiles,
                            const std::vector<RigidTransform>& cameras,
                            const std::vector<double>& times_s) {
  surfaces_in_.resize(tiles.tiles().size());
  for (const Surface& surface : world.surfaces) {
    if (!surface.visible) continue;
    const ViewCone cone = ConeAround(surface, world.bodies[surface.body], cameras, times_s);
    bool visible = false;
    for (std::size_t i = 0; i < tiles.tiles().size(); ++i) {
      const ImageTiles::Tile& tile = tiles.tiles()[i];
      const float reach = tile.radius + cone.radius;
      if (tile.dark ||
          (reach < std::numbers::pi_v<float> && tile.axis.dot(cone.axis) < std::cos(reach))) {
        continue;
      }
      visible = true;
      surfaces_in_[i].push_back(static_cast<int>(seen_.size()));
    }
    if (visible) seen_.emplace_back().surface = &surface;
  }
}

void FrameView::MakeHomographies(const World& world, const std::vector<RigidTransform>& cameras,
                                 const std::vector<double>& times_s) {
  homographies_.reserve(times_s.size() * seen_.size());
  std::vector<RigidTransform> camera_from_body(world.bodies.size());
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    const RigidTransform camera_from_world = cameras[k].Inverse();
    for (std::size_t body = 0; body < world.bodies.size(); ++body) {
      camera_from_body[body] = camera_from_world * world.bodies[body](times_s[k]);
    }
    homographies_.push_back(HomographyOf(GroundInCamera(cameras[k])));
    for (std::size_t i = 1; i < seen_.size(); ++i) {
      const Surface& surface = *seen_[i].surface;
      homographies_.push_back(HomographyOf(Placed(surface, camera_from_body[surface.body])));
    }
  }
}

void FrameView::Light(const World& world, const RigidTransform& camera, double time_s) {
  // A surface that faces a low sun gets more light than the ground, but within a limit.
  constexpr double kMinSunHeight = 0.25;
  const Lighting& light = world.light;
  for (SeenSurface& seen : seen_) {
    const PlacedSurface at = seen.surface
                                 ? Placed(*seen.surface, world.bodies[seen.surface->body](time_s))
                                 : GroundPlane();
    const Vector3d normal = at.normal();
    const double sine = std::max(normal.dot(light.to_sun), 0.0);
    seen.normal = normal.cast<float>();
    seen.plane_distance = std::abs(normal.dot(camera.translation - at.center));
    seen.direct =
        static_cast<float>(light.direct * sine / std::max(light.to_sun.z(), kMinSunHeight));
    seen.ambient = static_cast<float>((1 - light.direct) * (0.6 + 0.4 * normal.z()));
    seen.ground_from_point = AlongSunToGround(at, light.to_sun);
    if (seen.surface) {
      const Texture& paint = *seen.surface->paint;
      seen.pixel_size_m =
          2 * std::sqrt(at.right.norm() * at.up.norm() /
                        (static_cast<double>(paint.width_px()) * paint.height_px()));
    } else {
      seen.pixel_size_m = world.ground.map_size_m / world.ground.map->width_px();
    }
  }
}

void FrameView::MapShadows(const World& world, double time_s) {
  std::vector<RigidTransform> poses;
  std::vector<Vector3d> velocities;
  for (const Motion& body : world.bodies) {
    poses.push_back(body(time_s));
    const Vector3d step = body(time_s + kVelocityStep_s).translation - poses.back().translation;
    velocities.push_back(step / kVelocityStep_s);
  }
  for (SeenSurface& seen : seen_) {
    if (seen.direct <= 0) continue;
    const bool is_ground = seen.surface == nullptr;
    const PlacedSurface receiver =
        is_ground ? GroundPlane() : Placed(*seen.surface, poses[seen.surface->body]);
    for (const Surface& occluder : world.surfaces) {
      if (!occluder.casts_shadow || &occluder == seen.surface) continue;
      const PlacedSurface at = Placed(occluder, poses[occluder.body]);
      std::optional<ShadowMap> shadow = MapShadow(receiver, is_ground, occluder, at, world.light);
      if (!shadow) continue;
      if (is_ground) shadow->velocity = velocities[occluder.body].head<2>().cast<float>();
      seen.shadows.push_back(*shadow);
    }
  }
}

void FrameView::FindGroundShadows(const ImageTiles& tiles, int middle) {
  ground_shadows_in_.resize(tiles.tiles().size());
  const Eigen::Matrix3f& ground = Homography(middle, 0);
  for (std::size_t i = 0; i < tiles.tiles().size(); ++i) {
    const ImageTiles::Tile& tile = tiles.tiles()[i];
    if (tile.dark) continue;
    // The box around the part of the ground that the tile shows; all of the ground where the tile
    // reaches the horizon.
    Eigen::AlignedBox2f box;
    bool is_open = false;
    for (const Vector3f& ray : tile.rim) {
      const Vector3f hit = ground * ray;
      is_open = is_open || hit.z() <= 1e-4f;
      box.extend(Eigen::Vector2f(hit.head<2>() / hit.z()));
    }
    const std::vector<ShadowMap>& shadows = seen_[0].shadows;
    for (int k = 0; k < static_cast<int>(shadows.size()); ++k) {
      const ShadowMap& shadow = shadows[k];
      const Eigen::Matrix3f map = shadow.occluder_from_receiver;
      const Eigen::Matrix2f receiver_from_occluder = map.topLeftCorner<2, 2>().inverse();
      const Eigen::Vector2f center = receiver_from_occluder * -map.topRightCorner<2, 1>();
      // Motion over a few ms and the blur of the edge widen the shadow.
      const Eigen::Vector2f reach = receiver_from_occluder.cwiseAbs().rowwise().sum() +
                                    shadow.blur + 0.03f * shadow.velocity.cwiseAbs() +
                                    0.05f * box.sizes();
      const Eigen::AlignedBox2f shaded(Eigen::Vector2f(center - reach),
                                       Eigen::Vector2f(center + reach));
      if (is_open || box.intersects(shaded)) ground_shadows_in_[i].push_back(k);
    }
  }
}

}  // namespace kestrel
