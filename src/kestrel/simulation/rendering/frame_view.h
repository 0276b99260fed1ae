// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "kestrel/simulation/rendering/lens.h"
#include "kestrel/simulation/rendering/shadow_casting.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// The image divided into squares, each with a cone around the rays of its pixels.
class ImageTiles {
 public:
  static constexpr int kSide_px = 16;

  explicit ImageTiles(const Lens& lens);

  struct Tile {
    int left;
    int top;
    bool dark = true;                  // it receives no light
    Eigen::Vector3f axis{0, 0, 1};     // axis of the cone
    float radius = 0;                  // rad, half the opening of the cone
    std::vector<Eigen::Vector3f> rim;  // rays around it
  };
  std::span<const Tile> tiles() const { return tiles_; }

 private:
  std::vector<Tile> tiles_;
};

// A surface (or the ground) seen by the camera during one exposure.
struct SeenSurface {
  const Surface* surface = nullptr;  // null: the ground
  double plane_distance = 0;         // distance of the camera from its plane, m
  float ambient = 0;                 // light from the sky
  float direct = 0;                  // light from the sun where nothing is in between
  Eigen::Vector3f normal{0, 0, 1};   // in the world
  double pixel_size_m = 1;           // pixel size of its paint, geometric mean
  // Maps (x, y, 1) of a point on it to the point of the ground on the same ray of the sun.
  Eigen::Matrix<float, 2, 3> ground_from_point = Eigen::Matrix<float, 2, 3>::Zero();
  std::vector<ShadowMap> shadows;
};

// Precomputed once per frame by Render: where everything is at many moments of the exposure, which
// surface is visible in which part of the image, and which surface shades which.
//
// Every surface is a homography: for a ray r in the camera, (x, y, w) = h r, where (x / w, y / w)
// are the point's coordinates on the surface and 1 / w is the distance along the (unit) ray.
class FrameView {
 public:
  // 'times_s': the moments, in order; the middle one is the frame's time.
  FrameView(const World& world, const ImageTiles& tiles, const Motion& world_from_camera,
            const std::vector<double>& times_s, double time_s);

  // Index 0 is the ground.
  const SeenSurface& seen(int i) const { return seen_[i]; }
  const Eigen::Matrix3f& Homography(int moment, int i) const {
    return homographies_[moment * seen_.size() + i];
  }
  const Eigen::Matrix3f& WorldFromCamera(int moment) const { return rotations_[moment]; }

  // Surfaces other than the ground that a tile may show, and shadows that may fall on the ground in
  // it.
  std::span<const int> SurfacesIn(std::size_t tile) const { return surfaces_in_[tile]; }
  std::span<const int> GroundShadowsIn(std::size_t tile) const { return ground_shadows_in_[tile]; }

 private:
  void FindVisible(const World& world, const ImageTiles& tiles,
                   const std::vector<RigidTransform>& cameras, const std::vector<double>& times_s);
  void MapShadows(const World& world, double time_s);
  void FindGroundShadows(const ImageTiles& tiles, int middle);
  void MakeHomographies(const World& world, const std::vector<RigidTransform>& cameras,
                        const std::vector<double>& times_s);
  void Light(const World& world, const RigidTransform& camera, double time_s);

  std::vector<SeenSurface> seen_;
  std::vector<Eigen::Matrix3f> homographies_;  // ordered by moment
  std::vector<Eigen::Matrix3f> rotations_;
  std::vector<std::vector<int>> surfaces_in_;
  std::vector<std::vector<int>> ground_shadows_in_;
};

}  // namespace kestrel
