// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/comms/guard/guard_options.h"
#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/target_profile.h"
#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/thread_setup.h"
#include "kestrel/core/camera/exposure_controller.h"
#include "kestrel/flight/guidance/guidance_options.h"
#include "kestrel/flight/onboard/flight_recorder.h"
#include "kestrel/flight/onboard/gstreamer_camera.h"
#include "kestrel/flight/onboard/target_reporter.h"
#include "kestrel/flight/session/live_events.h"

namespace kestrel {

// The options of a flight, as `kestrel config` prints them in the group "fly".
struct FlightOptions {
  double rate_hz = 50;
  double link_delay_s = -1;
  double source_timeout_s = 60;
  double autopilot_timeout_s = 60;
  std::string pad_origin;
  TargetReporterOptions target;
  TargetMessageOptions messages;
  GuidanceOptions guidance;
  GuardOptions guard;
  LiveEventsOptions events;
  ThreadOptions vision_thread;
  GstreamerCameraOptions camera;
  bool control_exposure = false;
  ExposureOptions exposure;
  ConnectionOptions link;
  AutopilotOptions autopilot;
  FlightRecorderOptions recorder;

  static void Visit(auto& self, auto&& visit) {
    visit("rate_hz", self.rate_hz, Range{1, 400}, "rate of landing targets or set-points");
    visit(
        "link_delay_s", self.link_delay_s, Range{-1, 2},
        "delay from sending to the autopilot's use; negative: half of the fastest round trip that "
        "TIMESYNC measures");
    visit("source_timeout_s", self.source_timeout_s, MoreThan(0),
          "time without an image after which the flight ends");
    visit("autopilot_timeout_s", self.autopilot_timeout_s, MoreThan(0),
          "time without a heartbeat after which the flight ends");
    visit("pad_origin", self.pad_origin,
          "with --pad-position, where the flight is, as LATITUDE,LONGITUDE in degrees: the origin "
          "of an autopilot that has none; empty: none is set");
    visit.Group("target", self.target);
    visit.Group("messages", self.messages);
    visit.Group("guidance", self.guidance);
    visit.Group("guard", self.guard);
    visit.Group("events", self.events);
    visit.Group("vision_thread", self.vision_thread);
    visit.Group("camera", self.camera);
    visit("control_exposure", self.control_exposure,
          "the camera's exposure is set by the brightness of its images");
    visit.Group("exposure", self.exposure);
    visit.Group("link", self.link);
    visit.Group("autopilot", self.autopilot);
    visit.Group("recorder", self.recorder);
  }
  std::vector<std::string> Validate() const;
};

}  // namespace kestrel
