// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/flight/guidance/guidance_options.h"

namespace kestrel {

// Path of the search for a target: it stays at a place, and after a while runs on a spiral around
// it whose turns are as far apart as the camera sees. At the end of the spiral it begins anew.
class SearchPath {
 public:
  explicit SearchPath(const GuidanceOptions& options) : options_(options) {}

  struct Extent {
    double wait_s;    // at the place, before the spiral
    double radius_m;  // radius of the spiral; 0: it stays at the place
  };
  // Begins anew at 'place', m in the world.
  void Start(const Eigen::Vector2d& place, const Extent& extent);

  // Returns the place to be at 'seconds' after the last call. The path advances only while the UAV
  // keeps up with it.
  Eigen::Vector2d Advance(const Eigen::Vector2d& uav, double seconds);

 private:
  Eigen::Vector2d Point() const;

  GuidanceOptions options_;
  Eigen::Vector2d place_{0, 0};
  Extent extent_{0, 0};
  double waited_s_ = 0;
  double angle_ = 0;  // angle on the spiral, rad
};

}  // namespace kestrel
