// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/app/console/calibration_page.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// What the console's page calibrates with: as `kestrel calibrate mount|clock|lens` of the same
// source. 'folder': where it is saved, nothing of what is there is replaced; empty: nowhere.
// 'source' outlives the tools.
CalibrationPage::Tools CalibrationTools(const SourceArguments& source,
                                        const LandingPipelineOptions& options,
                                        const std::string& folder);

}  // namespace kestrel
