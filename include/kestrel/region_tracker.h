// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A tracker for whatever a person marks in an image: a car, a person, a boat.
//
// Example:
//   RegionTracker tracker;
//   tracker.Mark(first_image, first_time, cv::Rect2d(310, 200, 40, 60));
//   const RegionReport report = tracker.Track(next_image, next_time);
//   if (report.state == RegionState::kFollowing) std::cout << report.box_px << "\n";

#include "kestrel/vision/region/region_tracker.h"  // IWYU pragma: export
