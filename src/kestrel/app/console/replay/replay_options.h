// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/app/console/messages/console_feed.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// Returns the options that the page of a recording may change, with their values and the names of
// `kestrel config`: all but those of the target and those that cost memory.
ConsoleOptionList ReplayOptions(const LandingPipelineOptions& options);
ConsoleOptionList ReplayOptions(const HuntPipelineOptions& options);

// Returns the options changed by settings such as "landing.still=true" or "hunt.still=true". Throws
// InputError for a setting that the page may not change or that is malformed, and when the result
// is not valid.
LandingPipelineOptions WithSettings(LandingPipelineOptions options,
                                    const std::vector<std::string>& settings);
HuntPipelineOptions WithSettings(HuntPipelineOptions options,
                                 const std::vector<std::string>& settings);

}  // namespace kestrel
