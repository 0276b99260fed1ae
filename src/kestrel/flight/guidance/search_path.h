// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/flight/guidance/guidance_options.h"

namespace kestrel {

// Where to look for a target: at a place, and after a while on a spiral around it that widens as
// far as the camera sees, over and over.
class SearchPath {
 public:
  explicit SearchPath(const GuidanceOptions& options) : options_(options) {}

  // Begins anew at 'place', m.
  void Start(const Eigen::Vector2d& place);

  // Where to be 'seconds' after the last call; it goes on while the UAV keeps up with it.
  Eigen::Vector2d Advance(const Eigen::Vector2d& uav, double seconds);

 private:
  Eigen::Vector2d Point() const;

  GuidanceOptions options_;
  Eigen::Vector2d place_{0, 0};
  double waited_s_ = 0;
  double angle_ = 0;  // of the spiral, rad
};

}  // namespace kestrel
