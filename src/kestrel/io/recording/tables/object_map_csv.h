// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/vision/mapping/mapped_object.h"
#include "kestrel/vision/mapping/team_object.h"

namespace kestrel {

// Returns object_map.csv: a header row and one row per object. 'score': the digit of a cuboid, else
// the class's score. 'moving': 1 for an object that moves beyond doubt, if its class may move.
// 'digit': the most probable one by all its detections, empty when none was read.
std::string ObjectMapCsv(const std::vector<MappedObject>& objects, const ObjectModel& model);

// Returns team_map.csv: the same columns and 'uavs', the names of the UAVs that have the object in
// their maps, separated by spaces, and 'holder', the name of the UAV that has claimed it.
// 'first_seen_ns' and 'last_seen_ns' are empty, as each UAV has a clock of its own.
std::string TeamMapCsv(const std::vector<TeamObject>& objects, const ObjectModel& model);

}  // namespace kestrel
