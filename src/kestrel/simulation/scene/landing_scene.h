// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/ground_painter.h"
#include "kestrel/simulation/scene/light_options.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/scene/vehicle_motion.h"
#include "kestrel/simulation/scene/world.h"
#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/target/target_print.h"
#include "kestrel/vision/targets/make_target_detector.h"

namespace kestrel {

// The board with the pad, and the vehicle that carries it.
struct BoardOptions {
  std::string carrier = "pickup";  // pickup, car, box (0.4 m high) or none: on the ground
  double border_m = 0.08;          // dark frame around the white board
  double arm_variation_m = 0.03;   // the arms' length varies by up to this, more or less
  double dirt = 0.06;              // relative variation of the print
  int scratches = 4;               // places without ink
  double gloss = 0.15;             // strength of the sun's mirror image in it, in units of white
  double gloss_width_deg = 12;     // angle at which it has faded to 1 / e

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("carrier", self.carrier, "",
            "carrier of the board: pickup, car, box, or none: the board slides over the ground");
    visitor("border_m", self.border_m, "m", "dark frame around the white board");
    visitor("arm_variation_m", self.arm_variation_m, "m",
            "the arms may be this much shorter or longer");
    visitor("dirt", self.dirt, "1", "variation of the print's reflectance");
    visitor("scratches", self.scratches, "1", "places where the ink is gone");
    visitor("gloss", self.gloss, "1", "strength of the sun's mirror image in the board");
    visitor("gloss_width_deg", self.gloss_width_deg, "deg", "width of the sun's mirror image");
  }
  std::vector<std::string> Validate() const;
};

// Other things around.
struct SurroundingsOptions {
  int vehicles = 3;
  int lookalikes = 2;
  int banners = 3;
  bool landing_legs = true;  // of the UAV, in the corners of the image
  bool uav_shadow = true;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("vehicles", self.vehicles, "1", "other vehicles, parked");
    visitor("lookalikes", self.lookalikes, "1", "things on the ground that look like the pattern");
    visitor("banners", self.banners, "1", "banners around");
    visitor("landing_legs", self.landing_legs, "", "the UAV's legs in the corners of the image");
    visitor("uav_shadow", self.uav_shadow, "", "the UAV's shadow");
  }
  std::vector<std::string> Validate() const;
};

// Scene under a landing.
struct LandingSceneOptions {
  VehicleMotionOptions vehicle;
  TargetOptions target;
  LandingPattern pattern;  // of the kinds of target with a ring
  BoardOptions board;
  GroundOptions ground;
  SurroundingsOptions surroundings;
  LightOptions light;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor.Group("vehicle", self.vehicle);
    visitor.Group("target", self.target);
    visitor.Group("pattern", self.pattern);
    visitor.Group("board", self.board);
    visitor.Group("ground", self.ground);
    visitor.Group("surroundings", self.surroundings);
    visitor.Group("light", self.light);
  }
  std::vector<std::string> Validate() const;
};

// A world with a pad on a vehicle.
struct LandingScene {
  World world;
  LandingPattern pattern;  // as drawn, where the pad has one
  TargetPrint print;       // of the pad, as drawn
  Motion world_from_pattern;
  Path target;  // the pad's centre without the vehicle's shaking, which a UAV follows
};

// Each part of a simulated landing has its own random numbers: options of one part do not change
// another.
enum class LandingPart { kVehicle, kBoard, kFlight, kGround, kLight, kSurroundings, kStart, kWind };
Random RandomOf(std::uint64_t seed, LandingPart part);

// Draws all that 'options' leave open. Other things stand beside the vehicle's path within
// 'duration_s'. Gray (1 channel) or colour (3).
LandingScene MakeLandingScene(const LandingSceneOptions& options, double duration_s, int channels,
                              std::uint64_t seed);

}  // namespace kestrel
