// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Gains of a control that follows a path, which it makes of the commands, as ArduPilot's does:
//   thrust = a_path + p slip + i integral(slip) + d slip',  slip = v_path + place (x_path - x) - v.
// `fly` reads them from the autopilot's parameters; they are no options.
struct PathControl {
  double place = 0;  // 1/s
  double p = 0;      // 1/s; 0: they are not known
  double i = 0;      // 1/s^2
  double d = 0;

  bool is_known() const { return p > 0 && i > 0 && place > 0; }
};

// Meets gusts for such an autopilot, which takes no acceleration as it is: moves its path aside so
// far that the control leans against the air's push as that will be when the command takes effect.
// The push is what the lean does not explain of the motion. World, horizontal.
class GustFeed {
 public:
  explicit GustFeed(const PathControl& control) : control_(control) {}

  // Takes velocity (m/s) and lean (horizontal part of the thrust per vertical part), in order of
  // time.
  void Observe(Time now, const Eigen::Vector2d& velocity, const Eigen::Vector2d& lean);

  // The UAV rests on something, which takes the push: it begins anew with the next observation.
  void Forget();

  // Moves the path on to the newest observation, for the push 'ahead_s' later.
  void Move(double ahead_s);

  // Motion of the path beside the one that is flown, m/s and m/s^2.
  const Eigen::Vector2d& velocity() const { return path_.velocity; }
  const Eigen::Vector2d& acceleration() const { return path_.acceleration; }

 private:
  struct Path {
    Time time;
    Eigen::Vector2d integral{0, 0};  // of the displacement, m s
    Eigen::Vector2d displacement{0, 0};
    Eigen::Vector2d velocity{0, 0};
    Eigen::Vector2d acceleration{0, 0};
  };

  PathControl control_;
  std::optional<Time> time_;           // of the newest observation
  Eigen::Vector2d velocity_{0, 0};     // filtered
  Eigen::Vector2d lean_{0, 0};         // the newest one
  Eigen::Vector2d push_{0, 0};         // m/s^2
  Eigen::Vector2d push_change_{0, 0};  // m/s^3
  Path path_;
  bool is_moving_ = false;
};

}  // namespace kestrel
