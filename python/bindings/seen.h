// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "kestrel/hunt_pipeline.h"
#include "kestrel/landing_pipeline.h"
#include "kestrel/object_model.h"
#include "kestrel/target_detector.h"

namespace kestrel::python {

// Camera and shape for drawing a pad that was seen.
struct PadView {
  CameraModel camera;
  TargetShape shape;
};

// Results together with what they are drawn by, which they share with their detector.
struct SeenReport : TargetReport {
  std::shared_ptr<PadView> view;
};
struct SeenLanding : LandingObservation {
  std::shared_ptr<PadView> view;
};
struct SeenObjects : ObjectReport {
  std::shared_ptr<ObjectModel> model;
};
struct SeenHunt : HuntObservation {
  std::shared_ptr<ObjectModel> model;
};

// Describe a result in a line.
std::string InWords(const TargetDetection& detection);
std::string InWords(const TargetReport& report);

}  // namespace kestrel::python
