// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The tracker of a vehicle: measured positions in, late ones too; its motion now and in the near
// future out.
//
// Example:
//   TargetTracker tracker{TargetTrackerOptions()};
//   tracker.Add({.time = time,
//                .position_in_world = {4, 2, 1.5},
//                .covariance = 0.01 * Eigen::Matrix3d::Identity()});
//   if (const auto soon = tracker.Predict(time + std::chrono::milliseconds(500))) {
//     std::cout << soon->motion.position().transpose() << ", " << soon->speed() << " m/s\n";
//   }

#include "kestrel/vision/tracking/target_tracker.h"  // IWYU pragma: export
