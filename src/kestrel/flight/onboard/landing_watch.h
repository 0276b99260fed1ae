// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/comms/mavlink/autopilot.h"

namespace kestrel {

// Detects that the UAV has landed: it is disarmed after it was in the air.
class LandingWatch {
 public:
  // Call it often. 'z_m': height of the body in the world.
  void Observe(bool is_armed, LandedState state, double z_m);

  bool has_landed() const { return has_landed_; }

 private:
  bool was_armed_ = false;
  bool has_flown_ = false;
  bool has_landed_ = false;
  double armed_z_m_ = 0;
};

}  // namespace kestrel
