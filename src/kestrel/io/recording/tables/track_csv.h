// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// Lines of landing_track.csv, each with its newline; without a target its cells are empty.
std::string TrackCsvHeader();
std::string TrackCsvRow(const LandingObservation& observation);

// Lines of landing_prediction.csv: a prediction made at 'time' for 'prediction.time'.
std::string PredictionCsvHeader();
std::string PredictionCsvRow(Time time, const TargetEstimate& prediction);

}  // namespace kestrel
