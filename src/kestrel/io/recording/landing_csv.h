// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// Lines of landing_detections.csv, each with its newline. Unknown values are empty; lengths are
// rounded to 1e-6 m, pixels to 1e-3 px.
std::string LandingCsvHeader();
// 'only_in_image': positions before the camera are left out, as the lens is not known.
std::string LandingCsvRow(const std::string& frame_name, const LandingObservation& observation,
                          bool only_in_image = false);
// The row of a frame whose image cannot be read: rejected_at is "unreadable".
std::string UnreadableLandingCsvRow(const std::string& frame_name, Time time);

}  // namespace kestrel
