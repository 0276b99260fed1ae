// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/simulation/recordings/recording_plan.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {

// Unrelated images, made by LandingStillMaker.
struct StillsOptions {
  std::string show = "nothing";
  double min_altitude_m = 0.35;
  double max_altitude_m = 14;
  double max_tilt_deg = 40;
  double min_visible_fraction = 0.25;

  static void Visit(auto& self, auto&& visit) {
    visit("show", self.show, OneOf{{"nothing", "pattern", "lookalikes"}},
          "pattern or lookalikes: single images instead of a flight; nothing: a flight");
    visit("min_altitude_m", self.min_altitude_m, Range{0.1, 100}, "smallest height of the camera");
    visit("max_altitude_m", self.max_altitude_m, "largest height of the camera");
    visit("max_tilt_deg", self.max_tilt_deg, Range{0, 80}, "largest tilt of the camera");
    visit("min_visible_fraction", self.min_visible_fraction, Range{0, 1},
          "smallest part of the pattern that is in view");
  }
  std::vector<std::string> Validate() const;
};

// Plans a recording of 'frames' stills, one per second. The pattern, or the plane of the
// look-alikes, is the world's z = 0. The navigation has no error. Checks combinations of arguments
// (InputError); 'camera' has a mount.
RecordingPlan PlanStills(const StillsOptions& options, const LandingPattern& pattern, int frames,
                         double lens_half_angle_deg, const CameraCalibration& camera,
                         std::uint64_t seed);

}  // namespace kestrel
