// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// Objects of the treasure hunt (paper, section 3): coloured things to be found, and things of the
// same colours that are not to be found.
struct HuntObjectsOptions {
  std::string shape = "disc";  // of the red, green and blue ones: disc or cuboid
  double size_m = 0.2;         // diameter, or side of the cuboids
  int red = 4;
  int green = 4;
  int blue = 4;
  int yellow = 3;  // discs that move
  double yellow_speed_mps = 0.6;
  // wander: around a place, at about that speed; straight: away from it, at that speed.
  std::string yellow_path = "wander";
  int orange = 1;        // large discs, 0.5 m
  int orange_bars = 1;   // 2 m long
  int distractors = 10;  // other shapes
  double fading = 0.15;  // largest part by which the paint is bleached, 0 to 1
  double gloss = 0.25;   // largest strength of the sun's mirror image in the paint

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("shape", self.shape, "",
            "shape of the red, green and blue objects: disc, or cuboid with digit");
    visitor("size_m", self.size_m, "m", "diameter of the discs, side of the cuboids");
    visitor("red", self.red, "1", "red objects");
    visitor("green", self.green, "1", "green objects");
    visitor("blue", self.blue, "1", "blue objects");
    visitor("yellow", self.yellow, "1", "yellow discs, which move");
    visitor("yellow_speed_mps", self.yellow_speed_mps, "m/s", "typical speed of the yellow discs");
    visitor("yellow_path", self.yellow_path, "",
            "wander: about a place, at about that speed; straight: from there, at that speed");
    visitor("orange", self.orange, "1", "large orange discs, 0.5 m");
    visitor("orange_bars", self.orange_bars, "1", "orange bars, 2 m long");
    visitor("distractors", self.distractors, "1", "things of the same colours and other shapes");
    visitor("fading", self.fading, "1", "largest bleaching of the paint");
    visitor("gloss", self.gloss, "1", "largest strength of the sun's mirror image in the paint");
  }
  std::vector<std::string> Validate() const;
};

// An object that is to be found.
struct HuntObject {
  int id = 0;
  std::string color;  // red, green, blue, yellow, orange
  std::string shape;  // disc, cuboid, bar
  double size_m;      // diameter, side or length
  int digit = -1;     // of a cuboid, 0 to 9
  double yaw = 0;     // rad, in the world: reading direction of its digit
  Path center;        // of its upper face, in the world
  // Half the sides of its upper face, in the world; for a disc, of the square around it.
  Eigen::Vector2d half_size;
};

// Places everything in the rectangle 'half_area' around the middle. Returns what is to be found.
std::vector<HuntObject> AddHuntObjects(const HuntObjectsOptions& options,
                                       const Eigen::Vector2d& half_area, Random* random,
                                       World* world);

}  // namespace kestrel
