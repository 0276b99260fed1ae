// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/landing_watch.h"

#include <cmath>

namespace kestrel {
namespace {

constexpr double kFlownHeight_m = 1;  // a UAV that has risen or sunk by this has flown

}  // namespace

void LandingWatch::Observe(bool is_armed, LandedState state, double z_m) {
  if (!is_armed) {
    has_landed_ = has_landed_ || (was_armed_ && has_flown_);
    was_armed_ = has_flown_ = false;
    return;
  }
  if (!was_armed_) armed_z_m_ = z_m;
  was_armed_ = true;
  has_flown_ = has_flown_ || std::abs(z_m - armed_z_m_) > kFlownHeight_m ||
               state == LandedState::kInAir || state == LandedState::kLanding;
}

}  // namespace kestrel
