// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/base/time.h"
#include "kestrel/vision/pipeline/follow_pipeline.h"

namespace kestrel {

inline constexpr char kFollowTable[] = "follow_track.csv";

// Lines of follow_track.csv: a header row, then one row for every frame from the marked one on.
// 'observation': of such a frame. 'only_in_image': the lens is not known, so places are left out.
std::string FollowCsvHeader();
std::string FollowCsvRow(const std::string& frame_name, const FollowObservation& observation,
                         bool only_in_image = false);
// 'state' is "unreadable".
std::string UnreadableFollowCsvRow(const std::string& frame_name, Time time);

}  // namespace kestrel
