// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace kestrel {

struct TeamOptions {
  // Period of sending the own map, if it has changed, and of sending the digest, for which the
  // others send what is missing. Longer where the rate is used up.
  double tell_period_s = 0.5;
  double digest_period_s = 0.25;
  // A part sent or heard more recently than this is not sent again; covers the link's round trip.
  double resend_s = 0.5;
  // A UAV of which nothing was heard for so long is gone: its claim is free.
  double silence_s = 5;
  // Largest number of bytes that one UAV sends, without those of the transport.
  double rate_bytes_per_s = 9000;
  // Prior for another UAV's world before it is compared: error of its navigation, standard
  // deviations per axis and of the heading.
  double world_sigma_m = 1.5;
  double world_yaw_sigma_deg = 2;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("tell_period_s", self.tell_period_s, "s",
            "interval at which the UAV sends its own map");
    visitor("digest_period_s", self.digest_period_s, "s",
            "interval at which the UAV sends what it has received");
    visitor("resend_s", self.resend_s, "s", "interval before the same is sent again");
    visitor("silence_s", self.silence_s, "s", "silence after which the claims of a UAV end");
    visitor("rate_bytes_per_s", self.rate_bytes_per_s, "B/s", "largest data rate of a UAV");
    visitor("world_sigma_m", self.world_sigma_m, "m",
            "error of a UAV's navigation, standard deviation per axis");
    visitor("world_yaw_sigma_deg", self.world_yaw_sigma_deg, "deg",
            "error of its heading, standard deviation");
  }
  std::vector<std::string> Validate() const;
};

}  // namespace kestrel
