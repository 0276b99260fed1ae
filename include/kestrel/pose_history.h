// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The latest poses of the UAV, and its pose at the time of an image between them.
//
// Example:
//   PoseHistory poses(/*capacity=*/1000, /*max_gap=*/std::chrono::milliseconds(500));
//   poses.Add({.time = time - std::chrono::milliseconds(10), .world_from_body = {}});
//   poses.Add({.time = time + std::chrono::milliseconds(10), .world_from_body = {}});
//   if (const auto world_from_body = poses.Lookup(time)) {
//     std::cout << world_from_body->translation.transpose() << "\n";
//   }

#include "kestrel/core/poses/pose_history.h"  // IWYU pragma: export
