// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/base/limits.h"

namespace kestrel {

struct TeamOptions {
  // Period of sending the own map, if it has changed, and of sending the digest, for which the
  // others send what is missing. Longer where the rate is used up.
  static constexpr double kSendPeriod_s = 0.5;
  static constexpr double kDigestPeriod_s = 0.25;
  // A part sent or heard more recently than this is not sent again; covers the link's round trip.
  static constexpr double kResend_s = 0.5;

  double silence_s = 5;
  double rate_bytes_per_s = 9000;
  double world_sigma_m = 1.5;
  double world_yaw_sigma_deg = 2;

  static void Visit(auto& self, auto&& visit) {
    visit("silence_s", self.silence_s, Range{kDigestPeriod_s, 3600},
          "silence after which the claims of a UAV end");
    visit("rate_bytes_per_s", self.rate_bytes_per_s, Range{1000, 1e9},
          "[B/s] largest data rate of a UAV");
    visit("world_sigma_m", self.world_sigma_m, Range{1e-3, 100},
          "error of a UAV's navigation, standard deviation per axis");
    visit("world_yaw_sigma_deg", self.world_yaw_sigma_deg, Range{1e-3, 30},
          "error of its heading, standard deviation");
    visit.Gone({"tell_period_s", "digest_period_s", "resend_s"});
  }
};

}  // namespace kestrel
