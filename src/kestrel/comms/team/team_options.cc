// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/team_options.h"

#include "kestrel/core/base/violations.h"

namespace kestrel {

std::vector<std::string> TeamOptions::Validate() const {
  constexpr double kMinute_s = 60;
  constexpr double kMinPeriod_s = 0.01;
  std::vector<std::string> violations;
  RequireIn(tell_period_s, kMinPeriod_s, kMinute_s, "tell_period_s", &violations);
  RequireIn(digest_period_s, kMinPeriod_s, kMinute_s, "digest_period_s", &violations);
  RequireIn(resend_s, 0, kMinute_s, "resend_s", &violations);
  RequireIn(silence_s, digest_period_s, kMinute_s * kMinute_s, "silence_s", &violations);
  RequireIn(rate_bytes_per_s, 1000, 1e9, "rate_bytes_per_s", &violations);
  RequireIn(world_sigma_m, 1e-3, 100, "world_sigma_m", &violations);
  RequireIn(world_yaw_sigma_deg, 1e-3, 30, "world_yaw_sigma_deg", &violations);
  return violations;
}

}  // namespace kestrel
