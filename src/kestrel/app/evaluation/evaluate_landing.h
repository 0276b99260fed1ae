// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/app/evaluation/report.h"

namespace kestrel {

// Compares what `kestrel land` wrote into the folder 'output' (landing_detections.csv; if there,
// landing_track.csv and landing_prediction.csv) with the truth of 'recording'. Throws InputError
// when one of them is missing, at fault or does not belong to the other.
Report EvaluateLanding(const std::string& recording, const std::string& output);

}  // namespace kestrel
