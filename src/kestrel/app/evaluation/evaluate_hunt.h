// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/app/evaluation/report.h"

namespace kestrel {

// Compares the output of `kestrel hunt` in the folder 'output' (object_detections.csv and, if
// there, object_map.csv) with the truth of 'recording'. Throws InputError when a file is missing or
// not valid, or does not belong to the recording.
Report EvaluateHunt(const std::string& recording, const std::string& output);

}  // namespace kestrel
