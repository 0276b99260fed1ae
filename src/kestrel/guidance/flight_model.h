// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/base/time.h"
#include "kestrel/navigation/set_point.h"

namespace kestrel {

struct FlightModelOptions {
  bool is_used = true;  // false: nothing is fed forward but the acceleration
  // What is assumed until the flight has told better.
  double delay_s = 0.12;  // from sending a set-point to its effect, beside the link's delay
  double memory_s = 8;    // what is longer ago is forgotten

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("is_used", self.is_used, "", "what the flight tells is fed forward");
    visitor("delay_s", self.delay_s, "s", "from a set-point to its effect, before it is known");
    visitor("memory_s", self.memory_s, "s", "what is longer ago is forgotten");
  }
  std::vector<std::string> Validate() const;
};

// The air, by how the UAV leans against it.
struct AirEstimate {
  double drag = 0;                 // acceleration per speed through the air, 1/s
  Eigen::Vector2d wind{0, 0};      // velocity of the air, m/s
};

// How a UAV answers to set-points, learnt while it flies: the wind, its drag, and how late and how
// much too weakly its autopilot follows.
class FlightModel {
 public:
  explicit FlightModel(const FlightModelOptions& options);

  // The UAV at 'now', and the set-point that is sent now (nothing: none).
  void Observe(Time now, const Eigen::Vector3d& velocity, const Eigen::Vector3d& thrust_direction,
               const std::optional<SetPoint>& sent, double link_delay_s);

  // From sending a set-point to its effect, s.
  double delay_s() const;

  // The velocity to command so that the UAV flies with 'velocity' while it accelerates by
  // 'acceleration' (horizontal).
  Eigen::Vector2d Command(const Eigen::Vector2d& velocity,
                          const Eigen::Vector2d& acceleration) const;

  // Nothing until the UAV has flown in different directions.
  std::optional<AirEstimate> air() const;
};

}  // namespace kestrel
