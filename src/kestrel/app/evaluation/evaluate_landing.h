// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/app/evaluation/report.h"

namespace kestrel {

// Compares the output of `kestrel land` in the folder 'output' (landing_detections.csv and, if
// there, landing_track.csv and landing_prediction.csv) with the truth of 'recording'. Throws
// InputError when a file is missing or not valid, or does not belong to the recording.
Report EvaluateLanding(const std::string& recording, const std::string& output);

}  // namespace kestrel
