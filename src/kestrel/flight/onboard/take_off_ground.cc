// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/take_off_ground.h"

#include <utility>

namespace kestrel {

void TakeOffGround::Update(LandedState state, int reboots, std::optional<double> feet_z_m,
                           std::optional<double> under_home_m) {
  if (std::exchange(reboots_, reboots) != reboots) height_m_.reset();
  if (state == LandedState::kOnGround && feet_z_m) {
    height_m_ = feet_z_m;
  } else if (!height_m_ || (state == LandedState::kOnGround && under_home_m)) {
    height_m_ = under_home_m;
  }
}

}  // namespace kestrel
