// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

inline constexpr char kObjectTable[] = "object_detections.csv";

// Lines of object_detections.csv: a header row, then for each frame one row per object, or one row
// with the frame and its times only. 'shape': disc, cuboid, bar, or merged for touching discs,
// which have no position. 'digit': the most probable one, empty when none was read.
std::string ObjectCsvHeader();
std::string ObjectCsvRows(const std::string& frame_name, const HuntObservation& observation,
                          const ObjectModel& model);

}  // namespace kestrel
