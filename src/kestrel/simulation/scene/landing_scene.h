// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "kestrel/core/base/limits.h"
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
  std::string carrier = "pickup";
  double border_m = 0.08;
  double arm_variation_m = 0.03;
  double dirt = 0.06;
  int scratches = 4;
  double gloss = 0.15;
  double gloss_width_deg = 12;

  static void Visit(auto& self, auto&& visit) {
    visit("carrier", self.carrier, OneOf{{"pickup", "car", "box", "none"}},
          "carrier of the board; none: the board slides over the ground");
    visit("border_m", self.border_m, Range{0, 1}, "dark frame around the white board");
    visit("arm_variation_m", self.arm_variation_m, Range{0, 0.2},
          "the arms may be this much shorter or longer");
    visit("dirt", self.dirt, Range{0, 1}, "variation of the print's reflectance");
    visit("scratches", self.scratches, Range{0, 200}, "places where the ink is gone");
    visit("gloss", self.gloss, Range{0, 10}, "strength of the sun's mirror image in the board");
    visit("gloss_width_deg", self.gloss_width_deg, Range{1, 90}, "width of the sun's mirror image");
  }
};

// Other things around.
struct SurroundingsOptions {
  int vehicles = 3;
  int lookalikes = 2;
  int banners = 3;
  bool landing_legs = true;
  bool uav_shadow = true;

  static void Visit(auto& self, auto&& visit) {
    visit("vehicles", self.vehicles, Range{0, 100}, "other vehicles, parked");
    visit("lookalikes", self.lookalikes, Range{0, 100}, "things that look like the pattern");
    visit("banners", self.banners, Range{0, 100}, "banners around");
    visit("landing_legs", self.landing_legs, "the UAV's legs in the corners of the image");
    visit("uav_shadow", self.uav_shadow, "the UAV's shadow");
  }
};

// Scene under a landing.
struct LandingSceneOptions {
  VehicleMotionOptions vehicle;
  TargetOptions target;
  LandingPattern pattern;
  BoardOptions board;
  GroundOptions ground;
  SurroundingsOptions surroundings;
  LightOptions light;

  static void Visit(auto& self, auto&& visit) {
    visit.Group("vehicle", self.vehicle);
    visit.Group("target", self.target);
    visit.Group("pattern", self.pattern);
    visit.Group("board", self.board);
    visit.Group("ground", self.ground);
    visit.Group("surroundings", self.surroundings);
    visit.Group("light", self.light);
  }
};

// A world with a pad on a vehicle.
struct LandingScene {
  World world;
  LandingPattern pattern;  // as drawn, where the pad has one
  TargetPrint print;       // print of the pad, as drawn
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
