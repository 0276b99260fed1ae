// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "kestrel/io/recording/frame.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

inline constexpr char kLandingTable[] = "landing_detections.csv";

// Lines of landing_detections.csv, each with its newline. Unknown values are empty; lengths are
// rounded to 1e-6 m, pixels to 1e-3 px.
std::string LandingCsvHeader();
// 'only_in_image': positions before the camera are left out, as the lens is not known.
std::string LandingCsvRow(const std::string& frame_name, const LandingObservation& observation,
                          bool only_in_image = false);
// The same with the frame's own time, which differs from the observation's where several cameras
// have clocks of their own.
std::string LandingCsvRow(const Frame& frame, const LandingObservation& observation,
                          bool only_in_image);
// Value of rejected_at where the image cannot be read.
inline constexpr std::string_view kUnreadable = "unreadable";
// The row of a frame whose image cannot be read.
std::string UnreadableLandingCsvRow(const std::string& frame_name, Time time);

}  // namespace kestrel
