// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/take_off_ground.h"

#include <utility>

namespace kestrel {

void TakeOffGround::Update(LandedState state, int reboots, std::optional<double> feet_z_m,
                           std::optional<double> under_home_m) {
  if (std::exchange(reboots_, reboots) != reboots) height_m_.reset();
  const bool stands = state == LandedState::kOnGround;
  const std::optional<double> ground_m = stands && feet_z_m ? feet_z_m : under_home_m;
  if (!height_m_ || (stands && ground_m)) height_m_ = ground_m;
}

}  // namespace kestrel
