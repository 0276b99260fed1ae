// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include <Eigen/Core>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/scene/paint.h"
#include "kestrel/simulation/scene/world.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {

// A box on a body: 'center' and half the sides along x, y, z of the body's frame.
struct Box {
  Eigen::Vector3d center;
  Eigen::Vector3d half;
};

// Adds the five sides of a box that are visible from above; 'top' and 'side' are their paint.
void AddBox(int body, const Box& box, const std::shared_ptr<const Texture>& top,
            const std::shared_ptr<const Texture>& side, World* world);

// Adds a horizontal rectangle that is visible from above. 'yaw' is the angle from the body's x to
// its right side.
Surface& AddPlate(int body, const Eigen::Vector3d& center, double half_length, double half_width,
                  double yaw, const std::shared_ptr<const Texture>& paint, World* world);

// Adds a car or a pick-up 4.5 m long. Its body's frame: x forward, z up, origin on the ground under
// the middle. Returns the height of its roof, m.
double AddCar(int body, const Color& color, Random* random, World* world);
double AddPickup(int body, const Color& color, Random* random, World* world);

// Adds a vertical wall with letters on both sides, as they stand around an arena.
void AddBanner(const Eigen::Vector2d& center, double yaw, double length_m, double height_m,
               const Color& color, Random* random, World* world);

// Adds the UAV's shadow: an invisible body. 'size_m': from rotor to rotor.
void AddUavShadow(int body, double size_m, World* world);

// Returns a motion that stands still.
Motion Standing(const Eigen::Vector2d& place, double yaw);

}  // namespace kestrel
