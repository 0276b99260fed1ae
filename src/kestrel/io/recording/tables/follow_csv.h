// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/base/time.h"
#include "kestrel/vision/pipeline/follow_pipeline.h"

namespace kestrel {

inline constexpr char kFollowTable[] = "follow_track.csv";

// Lines of follow_track.csv: a header row, then one row per frame. 'state' is empty before
// something was marked, and "unreadable" for an image that cannot be read.
std::string FollowCsvHeader();
std::string FollowCsvRow(const std::string& frame_name, const FollowObservation& observation);
std::string UnreadableFollowCsvRow(const std::string& frame_name, Time time);

}  // namespace kestrel
