// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/vision/mapping/mapped_object.h"
#include "kestrel/vision/mapping/team_object.h"

namespace kestrel {

// object_map.csv: a header row and one row for each object. 'score': the digit of a cuboid, else
// the class's; 'moving': 1 for what moves beyond doubt, where its class may; 'digit': the likeliest
// by all its detections, empty where none was read.
std::string ObjectMapCsv(const std::vector<MappedObject>& objects, const ObjectModel& model);

// team_map.csv: the same and 'uavs', the names of those that have the object in their maps, with
// spaces between them, and 'holder', the name of the one that goes for it. 'first_seen_ns' and
// 'last_seen_ns' are empty: each has a clock of its own.
std::string TeamMapCsv(const std::vector<TeamObject>& objects, const ObjectModel& model);

}  // namespace kestrel
