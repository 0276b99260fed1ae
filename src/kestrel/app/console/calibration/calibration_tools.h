// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/app/console/calibration/calibration_page.h"
#include "kestrel/io/bags/open_recording.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// Returns the tools with which the page calibrates as `kestrel calibrate mount|clock|lens` does
// with the same source. 'folder': for the results; existing files are never replaced; empty:
// results are not saved. 'source' gives gray images.
CalibrationPage::Tools CalibrationTools(const RecordingChoice& source,
                                        const LandingPipelineOptions& options,
                                        const std::string& folder);

}  // namespace kestrel
