// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// object_detections.csv: a header row, then for every frame one row for each object, or one with
// the frame and its times alone. 'shape': disc, cuboid, bar, or merged for discs that touch, which
// have no position; 'digit': the likeliest, empty where none was read.
std::string ObjectCsvHeader();
std::string ObjectCsvRows(const std::string& frame_name, const HuntObservation& observation,
                          const ObjectModel& model);

}  // namespace kestrel
