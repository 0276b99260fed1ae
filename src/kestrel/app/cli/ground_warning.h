// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// What the objects say of the ground, where that contradicts what is told, and what to do; empty
// where nothing does. 'altitude_m': that of --altitude; 'has_world': the last frame had a pose.
std::string GroundWarning(const HuntPipeline& pipeline, std::optional<double> altitude_m,
                          bool has_world);

}  // namespace kestrel
