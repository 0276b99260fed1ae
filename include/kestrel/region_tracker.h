// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A tracker for whatever a person marks in an image: a car, a person, a boat.
//
// Example:
//   RegionTracker tracker;
//   tracker.Mark(image, time, cv::Rect2d(310, 200, 40, 60));
//   const RegionReport report = tracker.Track(image, time + std::chrono::milliseconds(33));
//   if (report.state == RegionState::kFollowing) std::cout << report.box_px << "\n";

#include "kestrel/vision/region/region_tracker.h"  // IWYU pragma: export
