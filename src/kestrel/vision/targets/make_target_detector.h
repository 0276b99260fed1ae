// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/target/target_detector.h"

namespace kestrel {

// What the target is. The options of the ring with a cross are LandingPatternDetectorOptions.
struct TargetOptions {
  std::string kind = "ring-cross";

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("kind", self.kind, "", "what the target is: ring-cross");
  }
  std::vector<std::string> Validate() const;
};

// Returns the detector of the target. 'ring': options of the kind "ring-cross". Throws InputError
// when the options or the camera are not valid.
std::unique_ptr<const TargetDetector> MakeTargetDetector(const CameraModel& camera,
                                                         const TargetOptions& target,
                                                         const LandingPatternDetectorOptions& ring);

// Returns the shape of that detector's pad. Throws InputError when the options of the target are
// not valid.
TargetShape ShapeOfTarget(const TargetOptions& target, const LandingPatternDetectorOptions& ring);

}  // namespace kestrel
