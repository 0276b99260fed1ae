// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// Returns how the objects' sizes contradict the given height of the ground, and what to do; empty
// where they do not. 'altitude_m': value of --altitude. 'has_world': the last frame had a pose.
std::string GroundWarning(const HuntPipeline& pipeline, std::optional<double> altitude_m,
                          bool has_world);

}  // namespace kestrel
