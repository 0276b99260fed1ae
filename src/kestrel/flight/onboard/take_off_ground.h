// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/comms/mavlink/autopilot_status.h"

namespace kestrel {

// The height of the ground at the take-off, in the autopilot's world (m).
class TakeOffGround {
 public:
  // The ground is under the feet as long as they stand on it, or under home where their height in
  // the autopilot's world is not known ('feet_z_m'). A program that starts in flight takes that
  // under home, once. A reboot begins anew: the autopilot may have another world then.
  void Update(LandedState state, int reboots, std::optional<double> feet_z_m,
              std::optional<double> under_home_m);

  std::optional<double> height_m() const { return height_m_; }

 private:
  std::optional<double> height_m_;
  int reboots_ = 0;
};

}  // namespace kestrel
