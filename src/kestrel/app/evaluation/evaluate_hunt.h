// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/app/evaluation/report.h"

namespace kestrel {

// Compares what `kestrel hunt` wrote into the folder 'output' (object_detections.csv; if there,
// object_map.csv) with the truth of 'recording'. Throws InputError when one of them is missing, at
// fault or does not belong to the other.
Report EvaluateHunt(const std::string& recording, const std::string& output);

}  // namespace kestrel
