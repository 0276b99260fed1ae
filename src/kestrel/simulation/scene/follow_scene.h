// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/limits.h"
#include "kestrel/simulation/scene/ground_painter.h"
#include "kestrel/simulation/scene/light_options.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// A thing that a person marks, and what makes it hard to follow.
struct FollowedThingOptions {
  std::string kind = "person";
  int lookalikes = 0;
  double first_crossing_s = 5;
  double crossing_period_s = 4;
  std::string cover = "none";
  double cover_at_s = 4;
  double covered_s = 3;

  static void Visit(auto& self, auto&& visit) {
    visit("kind", self.kind, OneOf{{"none", "person", "car", "boat"}}, "what is followed");
    visit("lookalikes", self.lookalikes, Range{0, 20},
          "things that look the same and cross its way close behind it or before it");
    visit("first_crossing_s", self.first_crossing_s, Range{0, 1e4}, "when the first one crosses");
    visit("crossing_period_s", self.crossing_period_s, Range{0.1, 1e4},
          "time from one crossing to the next");
    visit("cover", self.cover, OneOf{{"none", "tree", "bridge", "shade"}},
          "what it passes below; shade: the shadow of something that is not in view");
    visit("cover_at_s", self.cover_at_s, Range{0, 1e4}, "when it gets there");
    visit("covered_s", self.covered_s, Range{0.1, 100}, "time for which it is below");
  }

  bool is_there() const { return kind != "none"; }
};

// The parts of a scene that do not depend on the thing.
struct FollowSurroundings {
  GroundOptions ground;
  LightOptions light;
};

// A world with a thing to follow.
struct FollowScene {
  World world;
  int thing = 1;                // its body: origin on the ground, x ahead
  std::vector<int> lookalikes;  // theirs
};

// Draws all that the options leave open. 'thing': its motion; 'eye': from where it is seen, which
// determines the place of a tree or bridge that hides it. Gray (1 channel) or colour (3).
FollowScene MakeFollowScene(const FollowedThingOptions& options,
                            const FollowSurroundings& surroundings, const Motion& thing,
                            const Path& eye, int channels, std::uint64_t seed);

}  // namespace kestrel
