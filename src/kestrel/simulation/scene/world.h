// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/scene/texture.h"

namespace kestrel {

// A flat painted rectangle (or its ellipse), fixed to a body and visible from its front only. All
// solid things are made of these.
struct Surface {
  int body = 0;  // index in World::bodies
  // In the body's frame: the middle, and vectors from there to the middles of the right and the
  // upper side. The front is where right x up points to.
  Eigen::Vector3d center{0, 0, 0};
  Eigen::Vector3d right{1, 0, 0};
  Eigen::Vector3d up{0, 1, 0};
  bool round = false;                    // only the ellipse
  std::shared_ptr<const Texture> paint;  // its first row is the upper side
  std::shared_ptr<const Texture> mask;   // a hole where it is less than 0.5; may be null
  float gloss = 0;                       // strength of the sun's mirror image, in units of white
  float gloss_width = 0.2f;              // rad, at which it has faded to 1 / e
  bool visible = true;                   // false: it only casts a shadow, with 'mask' as its
                                         // opacity
  bool casts_shadow = true;
};

// The plane z = 0 of the world.
struct Ground {
  std::shared_ptr<const Texture> map;     // colours, centred on the origin
  double map_size_m = 64;                 // side of 'map'
  std::shared_ptr<const Texture> detail;  // one channel, repeated: details finer than the map, as a
                                          // factor around 1 (see kDetailMean)
  double detail_size_m = 2.5;             // side of 'detail'
  // Part of the sun that reaches the ground past things that are far away or outside of the world
  // (trees, houses); one channel, over the same square as 'map'; may be null.
  std::shared_ptr<const Texture> sunlit;
};

// Reflectance of the detail texture that changes nothing.
inline constexpr float kDetailMean = 0.25f;

// The light on a horizontal white surface in full light is 1.
struct Lighting {
  Eigen::Vector3d to_sun{0, 0, 1};     // unit vector, in the world
  double direct = 0.75;                // part of the light that comes directly from the sun
  double sun_radius = 0.0047;          // rad, of the disc, which blurs the shadows
  double sky_radiance = 0.9;           // near the horizon
  double haze_per_m = 0;               // part of the light that a metre of air absorbs
  double haze_radiance = 0.6;          // light that the air adds instead
  double haze_variation = 0;           // 0 to 1: dust comes in clouds
  double flare = 0;                    // sunlight that the lens scatters around the sun's image
  Eigen::Vector3d sun_color{1, 1, 1};  // blue, green, red; means of about 1
  Eigen::Vector3d sky_color{1, 1, 1};
};

// Everything that a camera can see. Body 0 stands still and has the world's frame.
struct World {
  int channels = 1;  // colour channels of all textures but masks, detail and sunlit: 1 gray, 3 BGR
  Ground ground;
  std::vector<Motion> bodies{[](double) { return RigidTransform(); }};
  std::vector<Surface> surfaces;
  Lighting light;
  // Height of the skyline, rad, over all directions in equal steps, and its reflected light.
  std::vector<float> skyline = std::vector<float>(1, 0.0f);
  float skyline_radiance = 0.15f;
};

}  // namespace kestrel
