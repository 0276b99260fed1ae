// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// The lines of landing_detections.csv, each with its newline. A value that is not known is empty;
// lengths have 1e-6 m, pixels 1e-3 px.
std::string LandingCsvHeader();
std::string LandingCsvRow(const std::string& frame_name, const LandingObservation& observation);

}  // namespace kestrel
