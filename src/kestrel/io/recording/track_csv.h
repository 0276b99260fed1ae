// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// The lines of landing_track.csv, each with its newline; a target that is not known is empty.
std::string TrackCsvHeader();
std::string TrackCsvRow(const LandingObservation& observation);

// The lines of landing_prediction.csv: made at 'time' for 'prediction.time'.
std::string PredictionCsvHeader();
std::string PredictionCsvRow(Time time, const TargetEstimate& prediction);

}  // namespace kestrel
