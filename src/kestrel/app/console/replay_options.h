// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/app/console/console_feed.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// The options that the page of a recording may change: none of them costs memory, or more time than
// the others leave. With their values, by the names of `kestrel config`.
ConsoleOptionList ReplayOptions(const LandingPipelineOptions& options);
ConsoleOptionList ReplayOptions(const HuntPipelineOptions& options);

// The options changed by settings, as "landing.still=true" or "hunt.still=true". Throw InputError
// for one that is none of those above or is malformed, and when the result is not valid.
LandingPipelineOptions WithSettings(LandingPipelineOptions options,
                                    const std::vector<std::string>& settings);
HuntPipelineOptions WithSettings(HuntPipelineOptions options,
                                 const std::vector<std::string>& settings);

}  // namespace kestrel
