// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/camera/ray_table.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/landing/location/pattern_locator.h"
#include "kestrel/vision/landing/score/ink_comparison.h"
#include "kestrel/vision/landing/score/ring_probe.h"
#include "kestrel/vision/landing/small_pattern/small_pattern.h"

namespace kestrel {

// The models that the detector computes once for its camera and pattern.
struct LandingModels {
  LandingModels(const CameraModel& camera_model, const LandingPatternDetectorOptions& all_options)
      : camera(camera_model),
        options(all_options),
        rays(camera),
        ring_probe(options.pattern),
        locator(camera, options.pattern),
        ink(options.pattern),
        small(camera, rays, options.pattern) {}
  // Not copyable: the parts refer to each other.
  LandingModels(const LandingModels&) = delete;
  LandingModels& operator=(const LandingModels&) = delete;

  CameraModel camera;
  LandingPatternDetectorOptions options;
  RayTable rays;
  RingProbe ring_probe;
  PatternLocator locator;
  InkComparison ink;
  SmallPatternFitter small;
  // Steps of the search plan that are left out, a bit each: a benchmark measures what each finds.
  std::uint32_t skipped_steps = 0;
  // The clock that bounds a search; a test has its own.
  std::chrono::steady_clock::time_point (*now)() = &std::chrono::steady_clock::now;
};

}  // namespace kestrel
