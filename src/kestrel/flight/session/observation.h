// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "kestrel/core/base/time.h"
#include "kestrel/io/recording/frame.h"
#include "kestrel/vision/pipeline/follow_pipeline.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// A frame and a pipeline's result for it: a landing pattern, coloured objects, or
// what is followed.
struct Observation {
  Frame frame;  // its pixels do not change any more
  std::variant<LandingObservation, HuntObservation, FollowObservation> seen;
  std::optional<Duration> latency = {};  // from capture until it was processed; live only
};

// A frame whose image cannot be read.
struct BrokenFrame {
  std::string name;
  Time time;
  std::string fault;       // names the file
  std::size_t camera = 0;  // as in Frame
};

// Returns the pose of the camera, if it is known.
inline std::optional<RigidTransform> WorldFromCamera(const Observation& observation) {
  return std::visit([](const auto& seen) { return seen.world_from_camera; }, observation.seen);
}

// Returns the time that the detection alone took.
inline Duration DetectTime(const Observation& observation) {
  return std::visit([](const auto& seen) { return seen.detect_time; }, observation.seen);
}

}  // namespace kestrel
