// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// Objects of the treasure hunt (paper, section 3): coloured things to be found, and things of the
// same colours that are not to be found.
struct HuntObjectsOptions {
  std::string shape = "disc";
  double size_m = 0.2;
  int red = 4;
  int green = 4;
  int blue = 4;
  int yellow = 3;
  double yellow_speed_mps = 0.6;
  std::string yellow_path = "wander";
  int orange = 1;
  int orange_bars = 1;
  int distractors = 10;
  double fading = 0.15;
  double gloss = 0.25;

  static void Visit(auto& self, auto&& visit) {
    visit("shape", self.shape, OneOf{{"disc", "cuboid"}},
          "shape of the red, green and blue objects; a cuboid has a digit");
    visit("size_m", self.size_m, Range{0.02, 2}, "diameter of the discs, side of the cuboids");
    visit("red", self.red, Range{0, 200}, "red objects");
    visit("green", self.green, Range{0, 200}, "green objects");
    visit("blue", self.blue, Range{0, 200}, "blue objects");
    visit("yellow", self.yellow, Range{0, 200}, "yellow discs, which move");
    visit("yellow_speed_mps", self.yellow_speed_mps, Range{0, 10}, "speed of the yellow discs");
    visit("yellow_path", self.yellow_path, OneOf{{"wander", "straight"}},
          "wander: about a place, at about that speed; straight: from there, at that speed");
    visit("orange", self.orange, Range{0, 200}, "large orange discs, 0.5 m");
    visit("orange_bars", self.orange_bars, Range{0, 200}, "orange bars, 2 m long");
    visit("distractors", self.distractors, Range{0, 200}, "other shapes of the same colours");
    visit("fading", self.fading, Range{0, 1}, "largest bleaching of the paint");
    visit("gloss", self.gloss, Range{0, 10}, "strength of the sun's mirror image");
  }
};

// An object that is to be found.
struct HuntObject {
  int id = 0;
  std::string color;  // red, green, blue, yellow, orange
  std::string shape;  // disc, cuboid, bar
  double size_m;      // diameter, side or length
  int digit = -1;     // digit on a cuboid, 0 to 9
  double yaw = 0;     // rad, in the world: reading direction of its digit
  Path center;        // centre of its upper face, in the world
  // Half the sides of its upper face, in the world; for a disc, of the square around it.
  Eigen::Vector2d half_size;
  // Its own surfaces in the world, from the first one to before the last one: without the robot
  // that carries it.
  std::size_t first_surface = 0, last_surface = 0;
};

// Places everything in the rectangle 'half_area' around the middle. Returns what is to be found.
std::vector<HuntObject> AddHuntObjects(const HuntObjectsOptions& options,
                                       const Eigen::Vector2d& half_area, Random* random,
                                       World* world);

}  // namespace kestrel
