// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/pipeline/hunt_pipeline.h"

namespace kestrel {

// object_detections.csv: a header row, then for every frame one row for each object of which the
// position is known, or one with the frame alone. Merged objects, and cut off ones without a
// position, are in the observation and in the annotated image, not here.
std::string ObjectCsvHeader();
std::string ObjectCsvRows(const std::string& frame_name, const HuntObservation& observation,
                          const ObjectModel& model);

}  // namespace kestrel
