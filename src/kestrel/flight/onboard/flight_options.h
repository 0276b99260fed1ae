// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/comms/guard/guard_options.h"
#include "kestrel/comms/mavlink/target_profile.h"
#include "kestrel/core/base/thread_setup.h"
#include "kestrel/flight/guidance/guidance_options.h"
#include "kestrel/flight/onboard/target_reporter.h"
#include "kestrel/flight/session/live_events.h"

namespace kestrel {

struct FlightOptions {
  double rate_hz = 50;
  // Time from sending to the autopilot's use, s; negative: half of the fastest round trip that
  // TIMESYNC measures. Set it where the link usually delays much more than at its fastest.
  double link_delay_s = -1;
  // After so long without images, or without the autopilot, the flight ends as failed.
  double source_timeout_s = 60;
  double autopilot_timeout_s = 60;
  TargetReporterOptions target;
  TargetMessageOptions messages;
  GuidanceOptions guidance;
  GuardOptions guard;  // used where guidance flies
  LiveEventsOptions events;
  ThreadOptions vision_thread;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("rate_hz", self.rate_hz, "Hz", "rate of landing targets or set-points");
    visitor("link_delay_s", self.link_delay_s, "s",
            "delay from sending to the autopilot's use; negative: as measured");
    visitor("source_timeout_s", self.source_timeout_s, "s",
            "time without an image after which the flight ends");
    visitor("autopilot_timeout_s", self.autopilot_timeout_s, "s",
            "time without a heartbeat after which the flight ends");
    visitor.Group("target", self.target);
    visitor.Group("messages", self.messages);
    visitor.Group("guidance", self.guidance);
    visitor.Group("guard", self.guard);
    visitor.Group("events", self.events);
    visitor.Group("vision_thread", self.vision_thread);
  }
  std::vector<std::string> Validate() const;
};

}  // namespace kestrel
