// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/base/limits.h"

namespace kestrel {

// From where the UAV follows what a person has marked.
struct FollowOptions {
  double distance_m = 12;
  double height_m = 8;
  std::string side = "free";

  static void Visit(auto& self, auto&& visit) {
    visit("distance_m", self.distance_m, Range{2, 200},
          "horizontal distance from what is followed");
    visit("height_m", self.height_m, Range{2, 200}, "height above the ground on which it is");
    visit("side", self.side,
          "where the UAV stays: free (on the line to it), behind (its motion), or the bearing from "
          "it to the UAV in degrees clockwise from north");
    visit.Gone({"resume_s"});
  }
  std::vector<std::string> Validate() const;

  // Returns the direction from the target to the UAV in rad from east to north; nothing for "free"
  // and "behind", and for a text that is not valid.
  std::optional<double> Bearing() const;
};

}  // namespace kestrel
